//! Which triangles touch along an edge.

use geometry::TriangleMesh;
use rayon::prelude::*;

/// No triangle lies there.
pub const NONE: u32 = u32::MAX;

/// For each triangle, its neighbour across the edges (0, 1), (1, 2) and (2, 0), or [`NONE`]. Vertices at the very same
/// place count as one, so a mesh of loose triangles holds together too; where more than two triangles share an edge,
/// they are paired in their order.
pub fn neighbours(mesh: &TriangleMesh) -> Vec<[u32; 3]> {
    let place = places(mesh);
    let mut edges: Vec<(u64, u32)> = mesh
        .triangles
        .par_iter()
        .enumerate()
        .flat_map_iter(|(t, triangle)| {
            let corner = triangle.map(|i| u64::from(place[i as usize]));
            (0..3).map(move |side| {
                let (a, b) = (corner[side], corner[(side + 1) % 3]);
                (a.min(b) << 32 | a.max(b), (3 * t + side) as u32)
            })
        })
        .collect();
    edges.par_sort_unstable();
    let mut neighbours = vec![[NONE; 3]; mesh.triangles.len()];
    let mut at = 0;
    while at + 1 < edges.len() {
        let ((edge, first), (next, second)) = (edges[at], edges[at + 1]);
        if edge == next {
            neighbours[first as usize / 3][first as usize % 3] = second / 3;
            neighbours[second as usize / 3][second as usize % 3] = first / 3;
            at += 1;
        }
        at += 1;
    }
    neighbours
}

/// For each vertex, the first vertex at the same place.
fn places(mesh: &TriangleMesh) -> Vec<u32> {
    // Adding zero makes -0 and 0 the same bits.
    let bits = |i: u32| mesh.vertices[i as usize].coords.map(|c| (c + 0.0).to_bits()).into();
    let mut order: Vec<([u32; 3], u32)> =
        (0..mesh.vertices.len() as u32).into_par_iter().map(|i| (bits(i), i)).collect();
    order.par_sort_unstable();
    let mut place = vec![0; mesh.vertices.len()];
    let mut first = 0;
    for (at, &(bits, vertex)) in order.iter().enumerate() {
        if bits != order[first].0 {
            first = at;
        }
        place[vertex as usize] = order[first].1;
    }
    place
}
