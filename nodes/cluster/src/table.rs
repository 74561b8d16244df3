//! The table on which the thing stands: found as the largest plane that nothing lies behind, and taken away.
//!
//! The paper cut its cow out by hand. Here: random triples of balls give planes (RANSAC, Fischler & Bolles 1981), of
//! which the best by count, of those that nothing lies behind, is fitted again to what lies on it; what lies on it or behind
//! it goes. A face of the thing itself has the rest of the thing behind it.

use nalgebra::{Matrix3, Point3, Vector3};
use wire::CloudPoint;

/// A plane: normal . p = distance_m, the normal towards the side from which it was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TablePlane {
    /// Unit normal, in the world.
    pub normal: [f64; 3],
    /// Along the normal.
    pub distance_m: f64,
    /// Root mean square distance of the balls on it.
    pub rms_m: f64,
    /// How many balls are on it.
    pub balls: usize,
}

/// A plane counts as a table when so many of all balls lie on it, and so many at most behind it.
const LEAST_SHARE: f64 = 0.05;
const MOST_BEHIND: f64 = 0.02;
const TRIALS: usize = 1500;
/// The trials look at no more balls than this, evenly spread: the plane is fitted to all of them afterwards.
const LOOKED_AT: usize = 4000;
/// In the trials, a ball within this of a plane lies on it.
const NEAR_M: f64 = 2e-3;
/// So far from the table, in multiples of its own roughness, a ball belongs to the thing; and at least so far.
const MARGIN_RMS: f64 = 5.0;
const LEAST_MARGIN_M: f64 = 4e-4;
const FITS: usize = 4;

impl TablePlane {
    /// Finds the table; `None` when no plane is large enough, or the largest has things on both sides.
    pub fn find(points: &[CloudPoint]) -> Option<Self> {
        let step = points.len().div_ceil(LOOKED_AT).max(1);
        let looked_at: Vec<&CloudPoint> = points.iter().step_by(step).collect();
        let faces_all = |normal: &Vector3<f64>, distance_m: f64| {
            let behind = |ball: &&&CloudPoint| normal.dot(&at(ball).coords) - distance_m < -NEAR_M;
            looked_at.iter().filter(behind).count() as f64 <= MOST_BEHIND * looked_at.len() as f64
        };
        let on = |normal: &Vector3<f64>, distance_m: f64| {
            looked_at.iter().filter(|ball| on_plane(ball, normal, distance_m, NEAR_M)).count()
        };
        let candidates = (0..TRIALS).filter_map(|trial| {
            let pick = |k: u64| {
                looked_at.get(random(trial as u64 * 3 + k) as usize % looked_at.len().max(1)).map(|ball| at(ball))
            };
            let (a, b, c) = (pick(0)?, pick(1)?, pick(2)?);
            let normal = (b - a).cross(&(c - a)).try_normalize(1e-9)?;
            let plane = (normal, normal.dot(&a.coords));
            [plane, (-plane.0, -plane.1)].into_iter().find(|(normal, distance_m)| faces_all(normal, *distance_m))
        });
        let (normal, distance_m) = candidates.max_by_key(|(normal, distance_m)| on(normal, *distance_m))?;
        let plane = (0..FITS)
            .try_fold(Self { normal: normal.into(), distance_m, rms_m: NEAR_M / 3.0, balls: 0 }, |plane, _| {
                plane.fit(points)
            })?;
        let share = |count: usize| count as f64 / points.len() as f64;
        let behind = points.iter().filter(|ball| plane.height_m(ball) < -plane.margin_m().max(NEAR_M)).count();
        (share(plane.balls) >= LEAST_SHARE && share(behind) <= MOST_BEHIND).then_some(plane)
    }

    /// Above the table.
    pub fn height_m(&self, ball: &CloudPoint) -> f64 {
        Vector3::from(self.normal).dot(&at(ball).coords) - self.distance_m
    }

    /// Balls higher than this belong to the thing.
    pub fn margin_m(&self) -> f64 {
        (MARGIN_RMS * self.rms_m).max(LEAST_MARGIN_M)
    }

    /// Least squares over the balls that lie within three sigma.
    fn fit(&self, points: &[CloudPoint]) -> Option<Self> {
        let normal = Vector3::from(self.normal);
        let near_m = (3.0 * self.rms_m).max(1e-5);
        let on: Vec<&CloudPoint> =
            points.iter().filter(|ball| on_plane(ball, &normal, self.distance_m, near_m)).collect();
        let count = on.len() as f64;
        if on.len() < 3 {
            return None;
        }
        let centre = on.iter().map(|ball| at(ball).coords).sum::<Vector3<f64>>() / count;
        let spread = on.iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, ball| {
            let d = at(ball).coords - centre;
            sum + d * d.transpose()
        });
        let eigen = spread.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        let axis: Vector3<f64> = eigen.eigenvectors.column(least).into();
        let seen_from = on.iter().map(|ball| Vector3::from(ball.normal).cast::<f64>()).sum::<Vector3<f64>>();
        let normal = if axis.dot(&seen_from) < 0.0 { -axis } else { axis };
        let rms_m = (eigen.eigenvalues[least].max(0.0) / count).sqrt();
        Some(Self { normal: normal.into(), distance_m: normal.dot(&centre), rms_m, balls: on.len() })
    }
}

fn at(ball: &CloudPoint) -> Point3<f64> {
    Point3::from(ball.position_m).cast()
}

/// On the plane, and facing the way of the plane: what touches the table has other normals.
fn on_plane(ball: &CloudPoint, normal: &Vector3<f64>, distance_m: f64, near_m: f64) -> bool {
    let facing = Vector3::from(ball.normal).cast::<f64>().dot(normal).abs() > 0.9;
    facing && (normal.dot(&at(ball).coords) - distance_m).abs() < near_m
}

/// The same numbers in every run (splitmix64).
fn random(index: u64) -> u64 {
    let z = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) >> 1
}
