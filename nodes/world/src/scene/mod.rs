//! What there is to be seen.

mod build;
mod error;
mod file;
mod table;

pub use error::SceneError;
pub use file::{ALL, Kind, ObjectSection, SceneFile, TableSection, Up};

use crate::HandSection;
use geometry::TriangleMesh;
use std::path::Path;

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

impl Scene {
    /// The toy cow on a table.
    pub fn cow() -> Result<Self, SceneError> {
        Self::of_one(ObjectSection { size_mm: COW_MM, ..ObjectSection::new(Kind::Cow) })
    }

    /// A mesh of the user's (OBJ, PLY, STL or GLB) on a table, its largest side scaled to `size_mm`.
    pub fn with_object(file: &Path, size_mm: f64) -> Result<Self, SceneError> {
        Self::of_one(ObjectSection { size_mm, file: Some(file.to_owned()), ..ObjectSection::new(Kind::Mesh) })
    }

    /// Reads a scene file; the meshes that it names lie beside it.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        let read = std::fs::read_to_string(path);
        let text = read.map_err(|source| SceneError::Read { path: path.to_owned(), source })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&text, folder).map_err(|e| e.in_file(path))
    }

    /// A scene from the text of its file; relative mesh paths start at `folder`.
    pub fn parse(text: &str, folder: &Path) -> Result<Self, SceneError> {
        let file: SceneFile = toml::from_str(text).map_err(|e| SceneError::Parse(e.to_string()))?;
        build::build(&file, folder)
    }

    /// The thing to be scanned.
    pub fn subject(&self) -> &Surface {
        &self.surfaces[self.subject]
    }

    /// Everything in one mesh, without colours: all that a perfect scan could find.
    pub fn whole_mesh(&self) -> TriangleMesh {
        let mut whole = TriangleMesh::default();
        self.surfaces.iter().for_each(|surface| whole.append(&surface.mesh));
        whole
    }

    fn of_one(object: ObjectSection) -> Result<Self, SceneError> {
        let file = SceneFile { table: Some(TableSection::default()), objects: vec![object], ..SceneFile::default() };
        build::build(&file, Path::new(""))
    }
}

/// The largest side of the cow that comes without a scene file.
const COW_MM: f64 = 150.0;
