//! OBJ with its materials (Wavefront), by the crate tobj.

use super::materials::{Part, join};
use super::{LoadedMesh, picture};
use crate::Reason;
use geometry::TriangleMesh;
use image::RgbImage;
use nalgebra::{Point3, Vector3};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

/// A material's picture (map_Kd) stands for its colour; without one, Kd is taken as it is, a display colour.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<LoadedMesh, Reason> {
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };
    // tobj reports its own word for whatever happens in here, so the reason is kept aside.
    let broken_library = RefCell::new(None);
    let load_materials = |named: &Path| {
        let looked_for = folder.join(named);
        std::fs::read(&looked_for)
            .map_err(|e| e.to_string())
            .and_then(|text| tobj::load_mtl_buf(&mut text.as_slice()).map_err(|e| e.to_string()))
            .map_err(|why| {
                let named = named.display().to_string();
                broken_library.replace(Some(Reason::Companion { named, looked_for, why }));
                tobj::LoadError::OpenFileFailed
            })
    };
    let loaded = tobj::load_obj_buf(&mut &bytes[..], &options, load_materials);
    let (models, materials) = loaded.map_err(|e| Reason::syntax(format!("no valid OBJ: {e}")))?;
    let materials = match (materials, broken_library.into_inner()) {
        (Ok(materials), _) => materials,
        (Err(_), Some(reason)) => return Err(reason),
        (Err(e), None) => return Err(Reason::syntax(e)),
    };
    let mut pictures: BTreeMap<&str, usize> = BTreeMap::new();
    let mut textures: Vec<RgbImage> = Vec::new();
    let mut parts = Vec::new();
    for model in &models {
        let mut part = Part { mesh: part_mesh(&model.mesh)?, ..Part::default() };
        if let Some(material) = model.mesh.material_id.and_then(|id| materials.get(id)) {
            part.base = material.diffuse.map(|kd| kd.map(|c| (c * 255.0).round() as u8));
            if let Some(name) = material.diffuse_texture.as_deref() {
                let number = match pictures.get(name) {
                    Some(&number) => number,
                    None => {
                        textures.push(picture::beside(folder, file_name(name))?);
                        pictures.insert(name, textures.len() - 1);
                        textures.len() - 1
                    }
                };
                (part.texture, part.base) = (Some(number), None);
            }
        }
        parts.push(part);
    }
    join(parts, &textures)
}

/// `map_Kd -s 1 1 1 skin.png`: options come first, the name last.
fn file_name(map: &str) -> &str {
    if map.starts_with('-') { map.rsplit(' ').next().unwrap_or(map) } else { map }
}

fn part_mesh(mesh: &tobj::Mesh) -> Result<TriangleMesh, Reason> {
    let triples = |values: &[f32]| values.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect::<Vec<_>>();
    if !mesh.indices.len().is_multiple_of(3) {
        return Err(Reason::syntax("a face is no polygon"));
    }
    Ok(TriangleMesh {
        vertices: triples(&mesh.positions).into_iter().map(Point3::from).collect(),
        normals: triples(&mesh.normals).into_iter().map(Vector3::from).collect(),
        colours: triples(&mesh.vertex_color).into_iter().map(|c| c.map(|c| (c * 255.0).round() as u8)).collect(),
        uv: mesh.texcoords.chunks_exact(2).map(|c| [c[0], 1.0 - c[1]]).collect(),
        triangles: mesh.indices.chunks_exact(3).map(|i| [i[0], i[1], i[2]]).collect(),
    })
}
