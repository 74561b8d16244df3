//! Distances as colours.

use crate::albedo::linear;
use geometry::{MeshError, MeshIndex, TriangleMesh};
use rayon::prelude::*;

/// From behind the truth over on it to before it, in sRGB; equal steps look about equal (after ColorBrewer's RdBu).
pub const SCALE: [[u8; 3]; 7] =
    [[21, 71, 140], [67, 136, 193], [156, 200, 226], [236, 236, 232], [244, 183, 146], [211, 99, 79], [152, 18, 45]];
/// The ends that a scale may have, in millimetres.
const ENDS_MM: [f64; 12] = [0.05, 0.1, 0.2, 0.25, 0.5, 1.0, 2.0, 2.5, 5.0, 10.0, 20.0, 50.0];

/// The signed distance of each vertex from the truth, in millimetres, positive outside.
pub fn vertex_distances_mm(mesh: &TriangleMesh, truth: &TriangleMesh) -> Result<Vec<f64>, MeshError> {
    let index = MeshIndex::new(truth)?;
    let distance = |p: &nalgebra::Point3<f32>| index.signed_distance(&p.map(f64::from)).unwrap_or(0.0) * 1e3;
    Ok(mesh.vertices.par_iter().map(distance).collect())
}

/// Where a scale ends on which 95 % of the surface can be told apart: the next round number beyond.
pub fn end_mm(p95_mm: f64) -> f64 {
    ENDS_MM.into_iter().find(|&end| end >= p95_mm).unwrap_or(100.0)
}

/// The linear colour of a distance; beyond the ends it is the ends'.
pub fn colour(distance_mm: f64, end_mm: f64) -> [f32; 3] {
    let last = (SCALE.len() - 1) as f64;
    let at = (0.5 * (distance_mm / end_mm + 1.0)).clamp(0.0, 1.0) * last;
    let low = (at.floor() as usize).min(SCALE.len() - 2);
    let between = (at - low as f64) as f32;
    [0, 1, 2].map(|k| linear(SCALE[low][k]) * (1.0 - between) + linear(SCALE[low + 1][k]) * between)
}
