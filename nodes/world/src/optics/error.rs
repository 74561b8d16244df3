//! Why there is no picture.

use crate::SimulationError;
use geometry::{MeshError, RigError};

/// A scene or a rig that no camera can show.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OpticsError {
    /// A number out of its range.
    #[error("[simulation.optics] {key} = {value}: {low} to {high}")]
    Value {
        /// The key.
        key: &'static str,
        /// What it holds.
        value: f64,
        /// The least that is understood.
        low: f64,
        /// The most.
        high: f64,
    },
    /// The section cannot be read.
    #[error(transparent)]
    Section(#[from] SimulationError),
    /// The handset cannot measure.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The laser looks away from what the camera sees.
    #[error("the laser's source {source_mm:?} mm and the sheet leave no direction for the fan")]
    Fan {
        /// As the rig says, or as it follows from the sheet.
        source_mm: [f64; 3],
    },
    /// A thing that has no surface.
    #[error("{name}: {source}")]
    Mesh {
        /// What the scene calls it.
        name: String,
        /// Why.
        source: MeshError,
    },
    /// A texture whose size contradicts its pixels, or without coordinates to use it.
    #[error("{name}: a texture of {width}x{height} with {pixels} pixels, for {coordinates} texture coordinates")]
    Texture {
        /// What the scene calls it.
        name: String,
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Pixels that are there.
        pixels: usize,
        /// Texture coordinates of the mesh.
        coordinates: usize,
    },
}
