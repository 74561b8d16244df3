//! PLY as a surface: vertices with normals, colours and texture coordinates, and faces.

use super::{LoadedMesh, picture};
use crate::Reason;
use crate::ply::{Column, Ply, Table};
use geometry::TriangleMesh;
use nalgebra::{Point3, Vector3};
use std::path::Path;

/// Polygons are cut into fans. A texture is taken where MeshLab puts it: a comment `TextureFile NAME`, and `s`, `t` at the
/// vertices or a list `texcoord` at the faces.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<LoadedMesh, Reason> {
    let ply = Ply::parse(bytes)?;
    let vertices = ply.table("vertex").ok_or_else(|| Reason::syntax("has no element \"vertex\""))?;
    let mut mesh = vertex_attributes(vertices)?;
    if ply.table("tristrips").is_some() {
        return Err(Reason::syntax("holds strips of triangles, which are not understood; save it with plain faces"));
    }
    let faces = ply.table("face").and_then(|t| Some((t, t.list(&["vertex_indices", "vertex_index"])?)));
    let Some((face_table, indices)) = faces else { return Ok(LoadedMesh { mesh, texture: None }) };
    for (face, polygon) in indices.rows().enumerate() {
        let corners = corners(face, polygon, mesh.vertices.len())?;
        mesh.triangles.extend(corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]));
    }
    let texture_name = ply.comments.iter().find_map(|c| c.strip_prefix("TextureFile "));
    let texture = texture_name.map(|name| picture::beside(folder, name.trim())).transpose()?;
    if texture.is_some()
        && let Some(wedges) = face_table.list(&["texcoord"])
    {
        mesh = with_wedges(&mesh, indices, wedges)?;
    }
    let texture = texture.filter(|_| !mesh.uv.is_empty());
    Ok(LoadedMesh { mesh, texture })
}

fn vertex_attributes(table: &Table) -> Result<TriangleMesh, Reason> {
    let xyz = table.scalars(["x", "y", "z"]).ok_or_else(|| Reason::syntax("its vertices have no x, y, z"))?;
    let rows = 0..table.rows;
    let triple = |columns: [&Column; 3], row: usize| columns.map(|c| c.values[row] as f32);
    let normals = table.scalars(["nx", "ny", "nz"]);
    let colours = ["", "diffuse_"].iter().find_map(|prefix| {
        table.scalars(["red", "green", "blue"].map(|name| format!("{prefix}{name}")).each_ref().map(String::as_str))
    });
    let uv = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]].iter().find_map(|&names| table.scalars(names));
    Ok(TriangleMesh {
        vertices: rows.clone().map(|row| Point3::from(triple(xyz, row))).collect(),
        normals: normals.map_or(Vec::new(), |n| rows.clone().map(|row| Vector3::from(triple(n, row))).collect()),
        colours: colours.map_or(Vec::new(), |c| rows.clone().map(|row| c.map(|c| c.byte(row))).collect()),
        uv: uv
            .map_or(Vec::new(), |[u, v]| rows.map(|row| [u.values[row] as f32, 1.0 - v.values[row] as f32]).collect()),
        triangles: Vec::new(),
    })
}

fn corners(face: usize, polygon: &[f64], vertices: usize) -> Result<Vec<u32>, Reason> {
    if polygon.len() < 3 {
        return Err(Reason::syntax(format!("face {face} has {} corners", polygon.len())));
    }
    let corner = |&index: &f64| {
        let known = index >= 0.0 && index < vertices as f64 && index.fract() == 0.0;
        let what = || format!("face {face} names vertex {index}, but there are {vertices}");
        if known { Ok(index as u32) } else { Err(Reason::syntax(what())) }
    };
    polygon.iter().map(corner).collect()
}

/// Texture coordinates that belong to the corners of faces: every corner becomes a vertex of its own.
fn with_wedges(mesh: &TriangleMesh, indices: &Column, wedges: &Column) -> Result<TriangleMesh, Reason> {
    let mut apart = TriangleMesh::default();
    for (face, (polygon, uv)) in indices.rows().zip(wedges.rows()).enumerate() {
        if uv.len() != 2 * polygon.len() {
            let what = format!("face {face} has {} corners and {} texture coordinates", polygon.len(), uv.len() / 2);
            return Err(Reason::syntax(what));
        }
        let first = apart.vertices.len() as u32;
        for (index, uv) in polygon.iter().map(|&i| i as usize).zip(uv.chunks_exact(2)) {
            apart.vertices.push(mesh.vertices[index]);
            apart.normals.extend(mesh.normals.get(index));
            apart.colours.extend(mesh.colours.get(index));
            apart.uv.push([uv[0] as f32, 1.0 - uv[1] as f32]);
        }
        apart.triangles.extend((1..polygon.len() as u32 - 1).map(|i| [first, first + i, first + i + 1]));
    }
    Ok(apart)
}
