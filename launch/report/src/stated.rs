//! What a surface says of its own error, held against the error that it has.

use crate::error_map::vertex_distances_mm;
use geometry::{METRES_PER_MM, MeshError, TriangleMesh};
use serde::{Deserialize, Serialize};

/// How honest the sigmas of a surface are: of a Gaussian error 68 % lie within one of them, 95 % within two.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StatedError {
    /// Median of the vertices' standard deviations.
    pub median_sigma_mm: f64,
    /// The share of vertices closer to the truth than one standard deviation, 0..1.
    pub within_one: f64,
    /// Closer than two.
    pub within_two: f64,
    /// Vertices that state one: what was filled in states none.
    pub vertices: usize,
}

/// Compares each vertex's distance from the truth with its sigma; those that state none are left out. `None` when no
/// vertex states one.
pub fn stated_error(
    mesh: &TriangleMesh,
    sigma_m: &[f32],
    truth: &TriangleMesh,
) -> Result<Option<StatedError>, MeshError> {
    let distances = vertex_distances_mm(mesh, truth)?;
    let sigmas = sigma_m.iter().map(|sigma| f64::from(*sigma) / METRES_PER_MM);
    let mut pairs: Vec<[f64; 2]> = sigmas
        .zip(distances)
        .filter(|(sigma, _)| *sigma > 0.0 && sigma.is_finite())
        .map(|(s, d)| [s, d.abs()])
        .collect();
    pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let Some(&[median_sigma_mm, _]) = pairs.get(pairs.len() / 2) else { return Ok(None) };
    let within = |times: f64| pairs.iter().filter(|[s, d]| *d <= times * s).count() as f64 / pairs.len() as f64;
    let (within_one, within_two) = (within(1.0), within(2.0));
    Ok(Some(StatedError { median_sigma_mm, within_one, within_two, vertices: pairs.len() }))
}
