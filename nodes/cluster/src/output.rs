//! From balls to points of the cloud: mean, normal, spread, and how well the mean is known.

use crate::clusterer::State;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use rayon::prelude::*;
use wire::CloudPoint;

/// Neighbours whose means span the tangent plane stand within so many D.
const NEIGHBOURHOOD: f64 = 2.0;
/// With fewer means (its own included) there is no plane.
const LEAST_MEANS: usize = 4;
/// A plane is wider than thick: the middle eigenvalue is at least this many times the smallest.
const FLATNESS: f64 = 4.0;

/// The points of these balls, in the order of `ids`.
pub fn points(state: &State, ids: &[u32], least_points: u32) -> Vec<CloudPoint> {
    // A list of neighbours for each thread: the balls are many and small.
    ids.par_iter().map_init(Vec::new, |near, &id| point(state, id, least_points, near)).collect()
}

fn point(state: &State, id: u32, least_points: u32, near: &mut Vec<u32>) -> CloudPoint {
    let ball = &state.balls[id as usize];
    let averages = ball.averages(state.steps_per_metre);
    let to_sensor = Vector3::from(averages.to_sensor);
    state.grid.near(ball.centre_m, NEIGHBOURHOOD * f64::from(state.radius_m), near);
    let means = means_about(state, id, least_points, near);
    let normal = towards(plane_normal(&means).unwrap_or(to_sensor), to_sensor);
    let [xx, yy, zz, xy, xz, yz] = averages.covariance_m2;
    let covariance = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let spread_squared = normal.dot(&(covariance * normal)).max(0.0);
    // Points of one picture err together, with its pose.
    let independent = ball.pictures.min(ball.count).max(1);
    let variance = spread_squared.max(averages.variance_m2) / f64::from(independent) + averages.region_variance_m2;
    CloudPoint {
        position_m: [0, 1, 2].map(|axis| (f64::from(ball.centre_m[axis]) + averages.offset_m[axis]) as f32),
        normal: normal.map(|c| c as f32).into(),
        spread_m: spread_squared.sqrt() as f32,
        sigma_m: variance.sqrt() as f32,
        count: if ball.count < least_points { 0 } else { ball.count },
        id,
        colour: [0; 4],
    }
}

/// The mean positions of a ball and its neighbours, about its centre: those near enough that are no outliers and were
/// seen from the same side (so that the two faces of a thin sheet are not mixed).
fn means_about(state: &State, id: u32, least_points: u32, near: &[u32]) -> Vec<Vector3<f64>> {
    let ball = &state.balls[id as usize];
    let own = Vector3::from(ball.averages(state.steps_per_metre).to_sensor);
    let centre = Vector3::from(ball.centre_m).map(f64::from);
    let reach = NEIGHBOURHOOD * f64::from(state.radius_m);
    let mean = |&other: &u32| {
        let neighbour = &state.balls[other as usize];
        let averages = neighbour.averages(state.steps_per_metre);
        let same_side = own.dot(&Vector3::from(averages.to_sensor)) > 0.0;
        let from_centre = Vector3::from(neighbour.centre_m).map(f64::from) - centre;
        let counts = neighbour.count >= least_points && same_side && from_centre.norm() <= reach;
        (counts || other == id).then(|| from_centre + Vector3::from(averages.offset_m))
    };
    near.iter().filter_map(mean).collect()
}

/// The direction in which the points spread least, when they lie about a plane (Hoppe 1992, section 3.1).
fn plane_normal(points: &[Vector3<f64>]) -> Option<Vector3<f64>> {
    if points.len() < LEAST_MEANS {
        return None;
    }
    let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
    let covariance = points.iter().map(|p| (p - mean) * (p - mean).transpose()).sum::<Matrix3<f64>>();
    let eigen = SymmetricEigen::new(covariance);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let flat = eigen.eigenvalues[order[1]] > FLATNESS * eigen.eigenvalues[order[0]].max(f64::MIN_POSITIVE);
    flat.then(|| eigen.eigenvectors.column(order[0]).into())
}

/// The unit vector along a direction, on the sensor's side; upwards when there is none.
fn towards(direction: Vector3<f64>, to_sensor: Vector3<f64>) -> Vector3<f64> {
    let unit = direction.try_normalize(1e-12).unwrap_or_else(Vector3::z);
    if unit.dot(&to_sensor) < 0.0 { -unit } else { unit }
}
