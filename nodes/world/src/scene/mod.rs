//! What there is to be seen.

use crate::HandSection;
use geometry::TriangleMesh;

/// A picture that colours a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green, blue (sRGB), row by row; `uv` (0, 0) is the outer corner of the first.
    pub rgb: Vec<[u8; 3]>,
}

/// One thing of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// What messages call it.
    pub name: String,
    /// In the world, in metres; with vertex colours (sRGB), or with `uv` for the texture, or grey.
    pub mesh: TriangleMesh,
    /// Colours the mesh by its `uv`.
    pub texture: Option<Texture>,
    /// Weight of the Phong lobe beside an albedo of 1; 0 is matt.
    pub specular: f32,
    /// Exponent of the Phong lobe.
    pub shininess: f32,
}

/// The known world, in metres, z up, the table's top at z = 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The things.
    pub surfaces: Vec<Surface>,
    /// Which of them is to be scanned: its mesh is the truth.
    pub subject: usize,
    /// Which of them is the table, if there is one.
    pub table: Option<usize>,
    /// Irradiance of the room's even light, in units of the lamp's at 0.2 m.
    pub ambient: f32,
    /// How the hand sweeps over it.
    pub hand: HandSection,
}

/// Why a scene cannot be shown.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// Not a scene file.
    #[error("{0}")]
    Parse(String),
}
