//! The tangent plane of each surfel (Hoppe et al. 1992, section 3.1: principal components of the neighbourhood).

use crate::grid::{BlockKey, Grid};
use crate::surfel::Surfel;
use nalgebra::{Matrix3, Vector3};

/// A surfel with the direction of its surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// The surfel's position.
    pub position: Vector3<f32>,
    /// Unit normal, outwards once `sided`.
    pub normal: Vector3<f32>,
    /// The surfel's weight.
    pub weight: f32,
    /// The surfel's stated variance.
    pub variance: f32,
    /// Radius within which it has neighbours enough, in metres: between one and two radii of the grid.
    pub reach_m: f32,
    /// Whether the side was seen; if not, `orient` finds it.
    pub sided: bool,
}

/// So many neighbours make a neighbourhood; where there are fewer within the radius, it grows.
const WANTED_NEIGHBOURS: f32 = 14.0;
const FEWEST_NEIGHBOURS: u32 = 5;
/// Second eigenvalue over the largest: below it the samples lie on a line and have no plane.
const LEAST_BREADTH: f32 = 0.01;

/// A radius grows to at most so many times itself where samples are sparse.
pub const MOST_REACH: f32 = 2.0;

/// The kernel of all local sums: smooth, 1 at the centre and 0 at the reach.
pub fn kernel(squared_over_reach_squared: f32) -> f32 {
    let u = 1.0 - squared_over_reach_squared;
    u * u
}

/// Weighted moments of a neighbourhood about its surfel.
#[derive(Default)]
struct Moments {
    neighbours: u32,
    weight: f32,
    first: Vector3<f32>,
    second: Matrix3<f32>,
    seen: Vector3<f32>,
}

fn moments(surfel: &Surfel, near: &[Surfel], reach_m: f32) -> Moments {
    let mut sum = Moments::default();
    let reach_squared = reach_m * reach_m;
    for other in near {
        let offset = other.position - surfel.position;
        let squared = offset.norm_squared();
        // What was seen from the other side belongs to another sheet.
        if squared >= reach_squared || surfel.seen.dot(&other.seen) < 0.0 {
            continue;
        }
        let weight = other.weight * kernel(squared / reach_squared);
        let scaled = offset / reach_m;
        sum.neighbours += 1;
        sum.weight += weight;
        sum.first += scaled * weight;
        sum.second += scaled * scaled.transpose() * weight;
        sum.seen += other.seen * weight;
    }
    sum
}

/// The tangent planes of `surfels`, those of one block; `near` are all within twice the radius of the block. A surfel whose
/// neighbours are too few or lie on a line has none.
pub fn planes(grid: &Grid, surfels: &[Surfel], near: &[Surfel]) -> Vec<Plane> {
    surfels.iter().filter_map(|surfel| plane(grid, surfel, near)).collect()
}

fn plane(grid: &Grid, surfel: &Surfel, near: &[Surfel]) -> Option<Plane> {
    let mut reach_m = grid.radius_m;
    let mut sum = moments(surfel, near, reach_m);
    let shortage = WANTED_NEIGHBOURS / sum.neighbours.max(1) as f32;
    if shortage > 1.0 {
        reach_m *= shortage.sqrt().min(MOST_REACH);
        sum = moments(surfel, near, reach_m);
    }
    if sum.neighbours < FEWEST_NEIGHBOURS || sum.weight <= 0.0 {
        return None;
    }
    let mean = sum.first / sum.weight;
    let eigen = (sum.second / sum.weight - mean * mean.transpose()).symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let [_, middle, largest] = order.map(|k| eigen.eigenvalues[k]);
    if largest.is_nan() || largest <= 0.0 || middle < LEAST_BREADTH * largest {
        return None;
    }
    let normal: Vector3<f32> = eigen.eigenvectors.column(order[0]).into();
    let side = normal.dot(&sum.seen);
    let normal = if side < 0.0 { -normal } else { normal };
    let Surfel { position, weight, variance, .. } = *surfel;
    Some(Plane { position, normal, weight, variance, reach_m, sided: sum.seen != Vector3::zeros() })
}

/// Whether a position matters to a block: within the largest reach of it.
pub fn within_reach(grid: &Grid, key: BlockKey, p: &Vector3<f32>) -> bool {
    grid.distance_squared(key, p) < (MOST_REACH * grid.radius_m).powi(2)
}
