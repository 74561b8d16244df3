//! The signed distance (Hoppe et al. 1992, section 3.4), blended over the near quadrics.
//!
//! Hoppe takes the one nearest tangent plane, and so has a step wherever the nearest one changes. Here the near quadrics are
//! averaged with a kernel that falls with distance (implicit moving least squares, Kolluri 2005; partition of unity,
//! Ohtake et al. 2003), but for those whose normals disagree with the nearest one's. Hoppe's own rule of where the distance is
//! undefined is kept: where the foot of the point lies farther than rho + delta from any sample. And it is undefined where the
//! samples around the foot all lie to one side of it: past a rim a quadric only guesses.

use crate::grid::{BlockKey, Grid};
use crate::quadric::Quadric;
use nalgebra::Vector3;

/// Hoppe's rho + delta, in reaches of the nearest quadric. Of random samples one voxel apart on average, a gap as wide
/// as this comes once in ten million.
const DEFINED_REACHES: f32 = 0.75;
/// How far the centre of the samples may lie off the foot, in reaches: 0.24 on a straight rim, about 0.4 where the surface ends.
const LOPSIDED_REACHES: f32 = 0.4;
/// Below this cosine a quadric belongs to another sheet or face than the nearest one.
const LEAST_AGREEMENT: f32 = 0.2;

/// The surface as seen from one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Signed distance in metres, positive outside.
    pub distance_m: f32,
    /// Unit normal.
    pub normal: Vector3<f32>,
    /// One standard deviation of the distance, in metres.
    pub sigma_m: f32,
}

fn falloff(squared: f32, quadric: &Quadric) -> f32 {
    let u = (1.0 - squared / (quadric.reach_m * quadric.reach_m)).max(0.0);
    u * u * u * u * quadric.weight
}

/// What makes a quadric the nearest: its distance, and thrice as much of it along the surface as across. At a crease, the face
/// whose samples a point stands over wins against the one that it would have to be stretched to.
fn remoteness(quadric: &Quadric, offset: &Vector3<f32>, squared: f32) -> f32 {
    3.0 * squared - 2.0 * quadric.normal.dot(offset).powi(2)
}

fn agreement(a: &Quadric, b: &Quadric) -> f32 {
    let cosine = a.normal.dot(&b.normal);
    if cosine < LEAST_AGREEMENT { 0.0 } else { cosine * cosine }
}

/// The surface around one point; `None` where no quadric reaches.
pub fn look(quadrics: &[Quadric], p: &Vector3<f32>) -> Option<Seen> {
    let reaches = |(q, d): &(&Quadric, Vector3<f32>)| d.norm_squared() < q.reach_m * q.reach_m;
    let in_reach: Vec<(&Quadric, Vector3<f32>)> = quadrics.iter().map(|q| (q, p - q.centre)).filter(reaches).collect();
    let remote = |(q, d): &(&Quadric, Vector3<f32>)| remoteness(q, d, d.norm_squared());
    let (nearest, _) = in_reach.iter().min_by(|a, b| remote(a).total_cmp(&remote(b)))?;
    let (mut weights, mut distance, mut sigma, mut gradient) = (0.0, 0.0, 0.0, Vector3::zeros());
    for (quadric, offset) in &in_reach {
        let weight = falloff(offset.norm_squared(), quadric) * agreement(nearest, quadric);
        weights += weight;
        distance += weight * quadric.distance(offset);
        sigma += weight * quadric.sigma_m;
        gradient += quadric.gradient(offset) * weight;
    }
    let slope = gradient.norm() / weights;
    let normal = gradient.try_normalize(0.0)?;
    (weights > 0.0).then(|| Seen { distance_m: distance / weights / slope, normal, sigma_m: sigma / weights })
}

/// Signed distances at the corners of a block's cells.
pub struct Corners {
    /// Corners along an edge: one more than cells.
    pub along: usize,
    /// x slowest, z fastest; NaN where undefined.
    pub distances_m: Vec<f32>,
}

/// Calls `visit` with the number of each corner that the quadric reaches, and the corner's offset from its centre.
fn each_corner(grid: &Grid, key: BlockKey, quadric: &Quadric, mut visit: impl FnMut(usize, Vector3<f32>, f32)) {
    let along = grid.cells + 1;
    let cell = grid.cell_m();
    let span = |axis: usize| {
        let first = grid.corner_number(key, [0; 3], axis) as f32;
        let low = ((quadric.centre[axis] - quadric.reach_m) / cell - first).floor().max(0.0) as usize;
        let high = ((quadric.centre[axis] + quadric.reach_m) / cell - first).ceil().min(grid.cells as f32);
        low..(high + 1.0).max(0.0) as usize
    };
    let reach_squared = quadric.reach_m * quadric.reach_m;
    for x in span(0) {
        for y in span(1) {
            for z in span(2) {
                let offset = grid.corner(key, [x, y, z]) - quadric.centre;
                let squared = offset.norm_squared();
                if squared < reach_squared {
                    visit((x * along + y) * along + z, offset, squared);
                }
            }
        }
    }
}

/// Weighted sums at one corner.
#[derive(Clone, Copy)]
struct Sum {
    remoteness: f32,
    nearest: u32,
    weight: f32,
    distance: f32,
    offset: Vector3<f32>,
}

const NOTHING: Sum =
    Sum { remoteness: f32::INFINITY, nearest: 0, weight: 0.0, distance: 0.0, offset: Vector3::new(0.0, 0.0, 0.0) };

impl Sum {
    /// The distance, or NaN where it is undefined.
    fn distance(&self, quadrics: &[Quadric], corner: &Vector3<f32>) -> f32 {
        if self.weight <= 0.0 {
            return f32::NAN;
        }
        let nearest = &quadrics[self.nearest as usize];
        let along = |offset: &Vector3<f32>| (offset - nearest.normal * nearest.normal.dot(offset)).norm();
        let far = along(&(corner - nearest.centre)) > DEFINED_REACHES * nearest.reach_m;
        let lopsided = along(&(self.offset / self.weight)) > LOPSIDED_REACHES * nearest.reach_m;
        if far || lopsided { f32::NAN } else { self.distance / self.weight }
    }
}

/// The distance at every corner of a block; `quadrics` are all that reach it, in the order of their blocks. Two blocks
/// that share a corner sum the same quadrics in the same order, so they agree on it to the last bit.
pub fn corners(grid: &Grid, key: BlockKey, quadrics: &[Quadric]) -> Corners {
    let along = grid.cells + 1;
    let mut sums = vec![NOTHING; along * along * along];
    for (index, quadric) in (0..).zip(quadrics) {
        each_corner(grid, key, quadric, |corner, offset, squared| {
            let remoteness = remoteness(quadric, &offset, squared);
            if remoteness < sums[corner].remoteness {
                sums[corner].remoteness = remoteness;
                sums[corner].nearest = index;
            }
        });
    }
    for quadric in quadrics {
        each_corner(grid, key, quadric, |corner, offset, squared| {
            let sum = &mut sums[corner];
            let weight = falloff(squared, quadric) * agreement(&quadrics[sum.nearest as usize], quadric);
            sum.weight += weight;
            sum.distance += weight * quadric.distance(&offset);
            sum.offset += offset * weight;
        });
    }
    let place = |n: usize| [n / (along * along), n / along % along, n % along];
    let distance = |(n, sum): (usize, &Sum)| sum.distance(quadrics, &grid.corner(key, place(n)));
    Corners { along, distances_m: sums.iter().enumerate().map(distance).collect() }
}
