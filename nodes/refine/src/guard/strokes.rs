//! Do the strokes cross?
//!
//! Where all stripes on a piece of surface run the same way, sliding the stripes along themselves changes nothing, and
//! what the hand-eye transform gets wrong along the stripe cannot be told from the surface's own shape.

use crate::scene::{FramePose, Problem};
use crate::surfel::Patch;
use nalgebra::Vector3;

/// How the stripes run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Strokes {
    /// The share of the surface on which stripes cross.
    pub crossing: f64,
    /// Along most stripes, in the world.
    pub along: Vector3<f64>,
}

/// Directions that differ by less than this, half of them each, do not cross: mean resultant of doubled angles.
const PARALLEL: f64 = 0.866;

/// Looks at each surfel's stripes, laid into its tangent plane.
pub(crate) fn look(problem: &Problem, poses: &[FramePose], patches: &[Patch]) -> Strokes {
    let sheet = sheet_normal(problem);
    let sheets: Vec<Vector3<f32>> = poses.iter().map(|pose| pose.camera_rotation * sheet).collect();
    let mut spread = nalgebra::Matrix3::zeros();
    let (mut crossing, mut all) = (0usize, 0usize);
    for patch in patches {
        for (members, middle) in patch.surfels().zip(&patch.middles) {
            let n = middle.normal;
            let first = if n.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() };
            let (u, v) = (n.cross(&first).normalize(), n.cross(&n.cross(&first)).normalize());
            let doubled = members.iter().filter_map(|member| {
                // A stripe runs where the sheet meets the surface.
                let along = sheets[member.frame as usize].cross(&n);
                let wide = along.cast::<f64>();
                spread += wide * wide.transpose();
                let (x, y) = (u.dot(&along), v.dot(&along));
                let square = x * x + y * y;
                (square > 1e-8).then(|| [(x * x - y * y) / square, 2.0 * x * y / square])
            });
            let (sum, count) = doubled.fold(([0.0, 0.0], 0usize), |(s, n), d| ([s[0] + d[0], s[1] + d[1]], n + 1));
            if count > 0 {
                all += 1;
                crossing += usize::from(f64::from(sum[0].hypot(sum[1])) < PARALLEL * count as f64);
            }
        }
    }
    Strokes { crossing: crossing as f64 / all.max(1) as f64, along: main_axis(spread) }
}

/// The direction that most stripes have, whichever way they run: of the sum of their squares.
fn main_axis(spread: nalgebra::Matrix3<f64>) -> Vector3<f64> {
    let eigen = spread.symmetric_eigen();
    eigen.eigenvectors.column(eigen.eigenvalues.imax()).into()
}

/// So many points tell where the sheet is.
const SHEET_POINTS: usize = 20_000;

/// Of the laser's sheet, in the frame of the camera: all points lie in it.
fn sheet_normal(problem: &Problem) -> Vector3<f32> {
    let frames = problem.frames.iter().map(|placed| &problem.gathered.frames[placed.frame].points);
    let all: usize = frames.clone().map(|points| points.len()).sum();
    let places = frames.flat_map(|points| points.iter()).step_by((all / SHEET_POINTS).max(1));
    let places: Vec<Vector3<f64>> = places.map(|point| Vector3::from(point.position_m).cast()).collect();
    let middle = places.iter().sum::<Vector3<f64>>() / places.len().max(1) as f64;
    let spread = places.iter().fold(nalgebra::Matrix3::zeros(), |sum: nalgebra::Matrix3<f64>, place| {
        sum + (place - middle) * (place - middle).transpose()
    });
    let eigen = spread.symmetric_eigen();
    eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned().cast()
}

/// Which of the six motions of the whole scan against itself the surface does not hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Hold {
    /// Of six; 3 for a plane or a sphere.
    pub directions: usize,
}

/// Below this share of the largest eigenvalue a motion is free.
const FREE: f64 = 2e-3;

/// From the normals of all surfels: sum of (n, c x n)(n, c x n)^T about their middle, turns measured at the rim.
pub(crate) fn hold(patches: &[Patch]) -> Hold {
    let middles: Vec<_> = patches.iter().flat_map(|patch| &patch.middles).collect();
    if middles.is_empty() {
        return Hold { directions: 0 };
    }
    let count = middles.len() as f64;
    let centre = middles.iter().map(|m| m.position.cast::<f64>()).sum::<Vector3<f64>>() / count;
    let off = |m: &crate::surfel::SurfelMiddle| m.position.cast::<f64>() - centre;
    let radius = (middles.iter().map(|m| off(m).norm_squared()).sum::<f64>() / count).sqrt().max(1e-6);
    let matrix = middles.iter().fold(nalgebra::Matrix6::zeros(), |mut sum: nalgebra::Matrix6<f64>, m| {
        let n = m.normal.cast::<f64>();
        let turn = off(m).cross(&n) / radius;
        let row = nalgebra::Vector6::new(n.x, n.y, n.z, turn.x, turn.y, turn.z);
        sum.ger(1.0, &row, &row, 1.0);
        sum
    });
    let eigenvalues = matrix.symmetric_eigenvalues();
    let largest = eigenvalues.max();
    Hold { directions: eigenvalues.iter().filter(|value| **value > FREE * largest).count() }
}
