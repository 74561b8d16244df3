//! Onto the disk.

use crate::{Report, page};
use formats::mesh::LoadedMesh;
use geometry::{MeshError, TriangleMesh};
use std::io::Write as _;
use std::path::Path;

/// What the page shows. A model without truth is shown alone.
#[derive(Debug, Clone, Copy, Default)]
pub struct Exhibits<'a> {
    /// What came out, in the world (see [`crate::painted`]).
    pub model: Option<&'a LoadedMesh>,
    /// So many of the model's triangles, the first ones, were measured; `None`: all.
    pub measured: Option<usize>,
    /// The surface with the standard deviation that each vertex states, in metres.
    pub stated: Option<(&'a TriangleMesh, &'a [f32])>,
    /// The surface with how far the points about each vertex lie off it (rms), in metres; NaN where there are none.
    pub residual: Option<(&'a TriangleMesh, &'a [f32])>,
    /// What would have come out without refinement.
    pub before: Option<&'a LoadedMesh>,
    /// What was scanned, in the same frame.
    pub truth: Option<&'a LoadedMesh>,
}

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// An exhibit is no surface.
    #[error("the report cannot show its surfaces: {0}")]
    Surface(#[from] MeshError),
    /// A picture could not be encoded.
    #[error("a picture of the report: {0}")]
    Picture(#[from] image::ImageError),
    /// A number that JSON cannot hold.
    #[error("the report as JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The disk.
    #[error(transparent)]
    File(#[from] formats::FormatError),
}

impl Report {
    /// Writes all numbers as JSON.
    pub fn write_json(&self, path: &Path) -> Result<(), PageError> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        write(path, &text)
    }

    /// Writes the page: one file that needs no other.
    pub fn write_html(&self, path: &Path, exhibits: &Exhibits<'_>) -> Result<(), PageError> {
        for surface in [exhibits.model, exhibits.before, exhibits.truth].into_iter().flatten() {
            surface.mesh.check()?;
        }
        write(path, &page::html(self, exhibits)?)
    }
}

fn write(path: &Path, text: &str) -> Result<(), PageError> {
    Ok(formats::write_whole(path, |out| Ok(out.write_all(text.as_bytes())?))?)
}
