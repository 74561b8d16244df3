//! Surfaces as PLY, STL and OBJ: metres, in the axes of the world (z up).

use crate::image_file::encode_png;
use crate::ply::PlyWriter;
use crate::{FormatError, Reason, write_whole};
use geometry::TriangleMesh;
use image::RgbImage;
use std::io::{self, Write};
use std::path::Path;

const UNITS: &str = "limn: metres, z up";

/// Writes a surface with its normals and vertex colours, when it has them.
pub fn write_ply(path: &Path, mesh: &TriangleMesh) -> Result<(), FormatError> {
    write_measured_ply(path, mesh, &[])
}

/// The same, with one standard deviation of each vertex along its normal, in metres, as `sigma_m`; none when there is not one
/// for every vertex.
pub fn write_measured_ply(path: &Path, mesh: &TriangleMesh, sigma_m: &[f32]) -> Result<(), FormatError> {
    mesh.check().map_err(|e| Reason::from(e).of(path))?;
    let sigma_m = if sigma_m.len() == mesh.vertices.len() { sigma_m } else { &[] };
    write_whole(path, |out| Ok(ply(out, mesh, sigma_m)?))
}

/// Writes the bare triangles, binary.
pub fn write_stl(path: &Path, mesh: &TriangleMesh) -> Result<(), FormatError> {
    mesh.check().map_err(|e| Reason::from(e).of(path))?;
    let count = u32::try_from(mesh.triangles.len());
    let count = count.map_err(|_| Reason::syntax("more triangles than STL can count").of(path))?;
    write_whole(path, |out| Ok(stl(out, mesh, count)?))
}

/// Writes a surface, and beside it, under the same name, the material (.mtl) and the texture (.png) when there is one;
/// without one, vertex colours go behind the coordinates, where MeshLab and Blender read them.
pub fn write_obj(path: &Path, mesh: &TriangleMesh, texture: Option<&RgbImage>) -> Result<(), FormatError> {
    mesh.check().map_err(|e| Reason::from(e).of(path))?;
    let texture = texture.filter(|_| !mesh.uv.is_empty());
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    if let Some(texture) = texture {
        write_whole(&path.with_extension("png"), |out| encode_png(out, texture))?;
        write_whole(&path.with_extension("mtl"), |out| {
            Ok(write!(out, "# {UNITS}\nnewmtl painted\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {name}.png\n")?)
        })?;
    }
    // Last, so that what it names is there when it is.
    write_whole(path, |out| Ok(obj(out, mesh, texture.map(|_| name.as_str()))?))
}

fn ply(out: &mut impl Write, mesh: &TriangleMesh, sigma_m: &[f32]) -> io::Result<()> {
    let mut ply = PlyWriter::begin(out, &[UNITS])?;
    ply.element("vertex", mesh.vertices.len())?;
    ply.properties("float", &["x", "y", "z"])?;
    if !mesh.normals.is_empty() {
        ply.properties("float", &["nx", "ny", "nz"])?;
    }
    if !mesh.colours.is_empty() {
        ply.properties("uchar", &["red", "green", "blue"])?;
    }
    if !sigma_m.is_empty() {
        ply.properties("float", &["sigma_m"])?;
    }
    ply.element("face", mesh.triangles.len())?;
    ply.properties("list uchar uint", &["vertex_indices"])?;
    ply.end_header()?;
    for (i, vertex) in mesh.vertices.iter().enumerate() {
        ply.values(vertex.coords.as_slice())?;
        ply.values(mesh.normals.get(i).map_or(&[], |n| n.as_slice()))?;
        ply.values(mesh.colours.get(i).map_or(&[], |c| c.as_slice()))?;
        ply.values(sigma_m.get(i..=i).unwrap_or_default())?;
    }
    for triangle in &mesh.triangles {
        ply.values(&[3_u8])?;
        ply.values(triangle)?;
    }
    Ok(())
}

fn stl(out: &mut impl Write, mesh: &TriangleMesh, count: u32) -> io::Result<()> {
    // Eighty bytes that must not begin with "solid".
    write!(out, "{UNITS:80}")?;
    out.write_all(&count.to_le_bytes())?;
    for t in 0..mesh.triangles.len() {
        let normal = mesh.area_normal(t).try_normalize(0.0).unwrap_or_default();
        out.write_all(bytemuck::cast_slice(normal.as_slice()))?;
        for corner in mesh.corners(t) {
            out.write_all(bytemuck::cast_slice(corner.coords.as_slice()))?;
        }
        out.write_all(&[0; 2])?;
    }
    Ok(())
}

fn obj(out: &mut impl Write, mesh: &TriangleMesh, material: Option<&str>) -> io::Result<()> {
    writeln!(out, "# {UNITS}")?;
    if let Some(name) = material {
        writeln!(out, "mtllib {name}.mtl\nusemtl painted")?;
    }
    for (i, p) in mesh.vertices.iter().enumerate() {
        write!(out, "v {} {} {}", p.x, p.y, p.z)?;
        match mesh.colours.get(i).filter(|_| material.is_none()) {
            Some(colour) => {
                let [r, g, b] = colour.map(|c| f32::from(c) / 255.0);
                writeln!(out, " {r} {g} {b}")?;
            }
            None => writeln!(out)?,
        }
    }
    let uv = if material.is_some() { mesh.uv.as_slice() } else { &[] };
    for [u, v] in uv {
        writeln!(out, "vt {u} {}", 1.0 - v)?;
    }
    for n in &mesh.normals {
        writeln!(out, "vn {} {} {}", n.x, n.y, n.z)?;
    }
    for triangle in &mesh.triangles {
        write!(out, "f")?;
        for i in triangle.map(|i| i + 1) {
            match (uv.is_empty(), mesh.normals.is_empty()) {
                (true, true) => write!(out, " {i}")?,
                (false, true) => write!(out, " {i}/{i}")?,
                (true, false) => write!(out, " {i}//{i}")?,
                (false, false) => write!(out, " {i}/{i}/{i}")?,
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
