//! The plane on which everything in sight stands.

use crate::uniform;
use nalgebra::{Matrix3, Point3, Vector3};

/// A point that was seen from a direction, or a ball with its normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facing {
    /// Metres.
    pub position: Point3<f64>,
    /// Unit vector towards whoever saw it, or the surface's normal.
    pub towards: Vector3<f64>,
}

/// What counts as a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TableSearch {
    /// In the trials, a point within this of a plane lies on it.
    pub near_m: f64,
    /// What lies on it faces the way of the plane: the least cosine.
    pub least_facing: f64,
    /// So many of all points lie on it.
    pub least_share: f64,
    /// So many at most lie behind it.
    pub most_behind: f64,
    /// Random triples of points that are tried.
    pub trials: u64,
    /// The trials look at no more points than this, evenly spread: the plane is fitted to all of them afterwards.
    pub looked_at: usize,
}

/// A plane: normal . p = distance_m, the normal towards the side from which it was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table {
    /// Unit normal, in the frame of the points.
    pub normal: Vector3<f64>,
    /// Along the normal.
    pub distance_m: f64,
    /// Root mean square distance of the points on it.
    pub rms_m: f64,
    /// How many points are on it.
    pub count: usize,
}

const FITS: usize = 4;
/// A fit takes what lies within so many times the root mean square of the fit before.
const WITHIN_RMS: f64 = 3.0;
/// Behind the table is what lies below it by so many times its own roughness.
const BEHIND_RMS: f64 = 5.0;

impl Table {
    /// Finds the plane of most points that nothing lies behind (RANSAC, Fischler and Bolles 1981), fitted again to all
    /// that lies on it. `None` when no plane is large enough, or the largest has things on both sides: a face of a thing
    /// has the rest of the thing behind it. The same points give the same table.
    pub fn find(points: &[Facing], search: &TableSearch) -> Option<Self> {
        let step = points.len().div_ceil(search.looked_at.max(1)).max(1);
        let looked_at: Vec<&Facing> = points.iter().step_by(step).collect();
        let most_behind = search.most_behind * looked_at.len() as f64;
        let first = |normal, distance_m| Self { normal, distance_m, rms_m: search.near_m / WITHIN_RMS, count: 0 };
        let nothing_behind = |plane: &Self| {
            looked_at.iter().filter(|point| plane.height_m(&point.position) < -search.near_m).count() as f64
                <= most_behind
        };
        let tried = (0..search.trials).filter_map(|trial| {
            let pick = |k: u64| {
                let place = uniform(0, trial * 3 + k) * looked_at.len() as f64;
                looked_at.get(place as usize).map(|point| point.position)
            };
            let (a, b, c) = (pick(0)?, pick(1)?, pick(2)?);
            let normal = (b - a).cross(&(c - a)).try_normalize(1e-9)?;
            let plane = first(normal, normal.dot(&a.coords));
            let flipped = first(-plane.normal, -plane.distance_m);
            [plane, flipped].into_iter().find(nothing_behind)
        });
        let on = |plane: &Self| {
            looked_at.iter().filter(|point| plane.has(point, search.near_m, search.least_facing)).count()
        };
        let best = tried.max_by_key(on)?;
        let plane = (0..FITS).try_fold(best, |plane, _| plane.fit(points, search.least_facing))?;
        let share = |count: usize| count as f64 / points.len() as f64;
        // What grows with each fit is a curved face that many planes touch.
        let is_plane = plane.rms_m < search.near_m;
        let below_m = (BEHIND_RMS * plane.rms_m).max(search.near_m);
        let behind = points.iter().filter(|point| plane.height_m(&point.position) < -below_m).count();
        (is_plane && share(plane.count) >= search.least_share && share(behind) <= search.most_behind).then_some(plane)
    }

    /// Above the table.
    pub fn height_m(&self, point: &Point3<f64>) -> f64 {
        self.normal.dot(&point.coords) - self.distance_m
    }

    /// Whether a point lies within so much of the plane, and faces its way.
    pub fn has(&self, point: &Facing, within_m: f64, least_facing: f64) -> bool {
        point.towards.dot(&self.normal) > least_facing && self.height_m(&point.position).abs() < within_m
    }

    /// Least squares over the points that lie on it.
    fn fit(&self, points: &[Facing], least_facing: f64) -> Option<Self> {
        let within_m = (WITHIN_RMS * self.rms_m).max(1e-5);
        let on: Vec<&Facing> = points.iter().filter(|point| self.has(point, within_m, least_facing)).collect();
        if on.len() < 3 {
            return None;
        }
        let count = on.len() as f64;
        let centre = on.iter().map(|point| point.position.coords).sum::<Vector3<f64>>() / count;
        let spread = on.iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, point| {
            let d = point.position.coords - centre;
            sum + d * d.transpose()
        });
        let eigen = spread.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        let axis: Vector3<f64> = eigen.eigenvectors.column(least).into();
        let normal = if axis.dot(&self.normal) < 0.0 { -axis } else { axis };
        let rms_m = (eigen.eigenvalues[least].max(0.0) / count).sqrt();
        Some(Self { normal, distance_m: normal.dot(&centre), rms_m, count: on.len() })
    }
}
