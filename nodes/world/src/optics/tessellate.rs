//! Large triangles are halved, so that light may be computed at their corners.

use geometry::TriangleMesh;
use nalgebra::Vector3;
use std::collections::HashMap;

/// Longer edges than this (6 mm at 200 mm is under 2 degrees of the lamp's light) are halved ...
const LONGEST_EDGE_M: f32 = 6e-3;
/// ... but no shorter than this share of the whole, so that a huge floor stays a finite work.
const SHARE: f32 = 1.0 / 300.0;

/// The same surface without long edges. The triangle to halve is cut at its longest edge, and both sides of an edge find
/// the same middle, so it stays closed where it was.
pub(super) fn tessellate(mesh: &TriangleMesh) -> TriangleMesh {
    let extent = mesh.bounds().map_or(0.0, |[low, high]| (high - low).max());
    let longest = LONGEST_EDGE_M.max(extent * SHARE);
    let mut fine = TriangleMesh { triangles: Vec::with_capacity(mesh.triangles.len()), ..mesh.clone() };
    fine.triangles.clear();
    let mut middles = HashMap::new();
    let mut waiting: Vec<[u32; 3]> = mesh.triangles.iter().rev().copied().collect();
    while let Some(triangle) = waiting.pop() {
        let lengths = [0, 1, 2].map(|i| edge_length(&fine, triangle[i], triangle[(i + 1) % 3]));
        let side = (0..3).fold(0, |best, i| if lengths[i] > lengths[best] { i } else { best });
        if lengths[side] <= longest {
            fine.triangles.push(triangle);
            continue;
        }
        let [a, b, c] = [0, 1, 2].map(|i| triangle[(side + i) % 3]);
        let middle = *middles.entry((a.min(b), a.max(b))).or_insert_with(|| halve(&mut fine, a, b));
        waiting.extend([[middle, b, c], [a, middle, c]]);
    }
    fine
}

fn edge_length(mesh: &TriangleMesh, a: u32, b: u32) -> f32 {
    (mesh.vertices[a as usize] - mesh.vertices[b as usize]).norm()
}

/// A vertex in the middle of two, with all that they carry.
fn halve(mesh: &mut TriangleMesh, a: u32, b: u32) -> u32 {
    let [i, j] = [a as usize, b as usize];
    let new = mesh.vertices.len() as u32;
    mesh.vertices.push(nalgebra::center(&mesh.vertices[i], &mesh.vertices[j]));
    if !mesh.normals.is_empty() {
        let sum = mesh.normals[i] + mesh.normals[j];
        mesh.normals.push(sum.try_normalize(0.0).unwrap_or_else(Vector3::z));
    }
    if !mesh.colours.is_empty() {
        let (p, q) = (mesh.colours[i], mesh.colours[j]);
        mesh.colours.push(std::array::from_fn(|k| p[k].midpoint(q[k])));
    }
    if !mesh.uv.is_empty() {
        let (p, q) = (mesh.uv[i], mesh.uv[j]);
        mesh.uv.push([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]);
    }
    new
}
