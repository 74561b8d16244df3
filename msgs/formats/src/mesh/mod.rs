//! Surfaces: read from OBJ, PLY, STL, GLB and glTF; written as OBJ, PLY, STL and GLB.
//!
//! Read numbers are those of the file, unit and axes; the caller scales. A colour is as a picture stores it (sRGB, 8 bits): glTF's linear
//! factors and vertex colours are converted. Texture coordinates have v down, whatever the format says.

mod glb;
mod gltf_buffers;
mod materials;
mod model;
mod obj;
mod picture;
mod ply;
mod srgb;
mod stl;
mod write;
mod write_glb;

pub use write::{write_measured_ply, write_obj, write_ply, write_stl};
pub use write_glb::write_glb;

use crate::{FormatError, Reason};
use geometry::TriangleMesh;
use image::RgbImage;
use std::path::Path;

/// The endings that [`read`] understands.
pub const KNOWN: &str = "obj, ply, stl, glb, gltf";

/// A surface from a file.
///
/// The colour of a point is the texture's at its `uv` (wrapped into 0..1) when there is a texture, else the vertex
/// colours', else unknown.
#[derive(Debug, Clone)]
pub struct LoadedMesh {
    /// In the units of the file.
    pub mesh: TriangleMesh,
    /// One picture for the whole mesh; several of the file's are stacked into one.
    pub texture: Option<RgbImage>,
}

/// Reads a surface; the format is told by the ending of the name.
///
/// Fails on a missing file, an unknown ending, bytes that are not the format or stop early, a mesh without faces, with
/// vertices that are not finite or faces that name no vertex, and on a picture that is named and not there.
pub fn read(path: &Path) -> Result<LoadedMesh, FormatError> {
    read_bytes(path).map_err(|reason| reason.of(path))
}

/// [`read`] in the axes of the world: glTF prescribes y up, so what comes from there is turned to z up, and a model that
/// [`write_glb`] wrote lies again where it was scanned. The other formats prescribe nothing and are left as they are.
pub fn read_z_up(path: &Path) -> Result<LoadedMesh, FormatError> {
    let mut loaded = read(path)?;
    if path.extension().is_some_and(|found| found.eq_ignore_ascii_case("glb") || found.eq_ignore_ascii_case("gltf")) {
        let z_up = |x: f32, y: f32, z: f32| [x, -z, y];
        loaded.mesh.vertices.iter_mut().for_each(|p| *p = z_up(p.x, p.y, p.z).into());
        loaded.mesh.normals.iter_mut().for_each(|n| *n = z_up(n.x, n.y, n.z).into());
    }
    Ok(loaded)
}

fn read_bytes(path: &Path) -> Result<LoadedMesh, Reason> {
    let found = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let parse = match found.as_str() {
        "obj" => obj::read,
        "ply" => ply::read,
        "stl" => stl::read,
        "glb" | "gltf" => glb::read,
        _ => return Err(Reason::Extension { found, known: KNOWN }),
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let loaded = parse(&std::fs::read(path)?, folder)?;
    loaded.mesh.check()?;
    Ok(loaded)
}
