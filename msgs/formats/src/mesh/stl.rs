//! STL: loose triangles, binary or as text (3D Systems, "StereoLithography Interface Specification", 1989).

use super::LoadedMesh;
use crate::Reason;
use crate::bytes::Cursor;
use geometry::TriangleMesh;
use nalgebra::Point3;
use std::collections::HashMap;
use std::path::Path;

const HEADER_BYTES: usize = 80;
const FACET_BYTES: usize = 50;

/// Corners at exactly the same place become one vertex; the normals of the file are dropped, since they follow from the
/// corners.
pub(super) fn read(bytes: &[u8], _folder: &Path) -> Result<LoadedMesh, Reason> {
    // Some programs begin binary files with "solid" too; the length tells them apart.
    let is_text = bytes.trim_ascii_start().starts_with(b"solid") && !has_binary_length(bytes);
    let corners = if is_text { text_corners(bytes)? } else { binary_corners(bytes)? };
    Ok(LoadedMesh { mesh: weld(&corners), texture: None })
}

fn has_binary_length(bytes: &[u8]) -> bool {
    let count = bytes.get(HEADER_BYTES..HEADER_BYTES + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    count.is_some_and(|count| bytes.len() == HEADER_BYTES + 4 + FACET_BYTES * count as usize)
}

fn binary_corners(bytes: &[u8]) -> Result<Vec<[f32; 3]>, Reason> {
    let mut cursor = Cursor::new(bytes);
    cursor.take(HEADER_BYTES, "the header")?;
    let count = u32::from_le_bytes(cursor.array("the count of triangles")?);
    let mut corners = Vec::new();
    for facet in 0..count {
        let inside = || Reason::truncated(format!("triangle {facet} of {count}"));
        let _normal: [u8; 12] = cursor.array("").map_err(|_| inside())?;
        for _ in 0..3 {
            let point: [u8; 12] = cursor.array("").map_err(|_| inside())?;
            corners.push(bytemuck::pod_read_unaligned(&point));
        }
        let _attribute: [u8; 2] = cursor.array("").map_err(|_| inside())?;
    }
    Ok(corners)
}

fn text_corners(bytes: &[u8]) -> Result<Vec<[f32; 3]>, Reason> {
    let mut cursor = Cursor::new(bytes);
    let mut corners = Vec::new();
    let mut line_number = 0;
    let mut ended = false;
    while let Some(line) = cursor.next_line() {
        line_number += 1;
        let words: Vec<&str> = std::str::from_utf8(line).unwrap_or_default().split_ascii_whitespace().collect();
        match words.as_slice() {
            ["vertex", x, y, z] => {
                let number = |word: &str| {
                    let what = || format!("{word:?} is no number");
                    word.parse().map_err(|_| Reason::Line { line: line_number, what: what() })
                };
                corners.push([number(x)?, number(y)?, number(z)?]);
            }
            ["vertex", ..] => {
                return Err(Reason::Line { line: line_number, what: "a vertex needs three numbers".into() });
            }
            ["endsolid", ..] => ended = true,
            ["endfacet", ..] if !corners.len().is_multiple_of(3) => {
                return Err(Reason::Line { line: line_number, what: "a facet needs three vertices".into() });
            }
            _ => {}
        }
    }
    if ended { Ok(corners) } else { Err(Reason::truncated("the solid (no \"endsolid\")")) }
}

/// Numbers vertices in the order in which they come first, so that the same file gives the same mesh.
fn weld(corners: &[[f32; 3]]) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let mut numbers: HashMap<[u32; 3], u32> = HashMap::new();
    let mut number = |corner: &[f32; 3]| {
        // Adding zero makes -0 the same place as 0.
        let place = corner.map(|c| (c + 0.0).to_bits());
        *numbers.entry(place).or_insert_with(|| {
            mesh.vertices.push(Point3::from(*corner));
            mesh.vertices.len() as u32 - 1
        })
    };
    let triangles = corners.chunks_exact(3).map(|c| [number(&c[0]), number(&c[1]), number(&c[2])]).collect();
    mesh.triangles = triangles;
    mesh
}
