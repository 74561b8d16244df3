//! Lays one surface onto another: trimmed point-to-plane ICP (Chen and Medioni 1992; trimming after Chetverikov 2002).

use crate::{CompareError, MeshIndex, SurfaceSample, TriangleMesh};
use nalgebra::{Isometry3, Matrix6, Point3, SymmetricEigen, Translation3, UnitQuaternion, Vector3, Vector6};
use rayon::prelude::*;

/// How a model was laid onto the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alignment {
    /// `truth_from_model * p_in_model = p_in_truth`.
    pub truth_from_model: Isometry3<f64>,
    /// Root mean square distance, along the normals, of the pairs that were kept.
    pub rms_mm: f64,
    /// The share of points whose pair was kept, 0..1.
    pub kept_share: f64,
    /// How many steps were made.
    pub iterations: usize,
    /// False when the steps were still long at the last of them.
    pub converged: bool,
    /// How many of the six directions the surface holds fast: 6 for most things, 3 for a plane or a sphere. The other
    /// directions were left as they were.
    pub observed_directions: usize,
}

/// Why nothing could be aligned.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AlignError {
    /// One of the two is no surface.
    #[error(transparent)]
    Surface(#[from] CompareError),
    /// The start is NaN.
    #[error("the transform to start from is not finite")]
    Start,
}

const SAMPLES: usize = 20_000;
const ITERATIONS: usize = 100;
/// Pairs farther apart than so many robust standard deviations are left out.
const TRIM_SIGMAS: f64 = 3.0;
/// The median of |x| is this times the standard deviation of a Gaussian.
const SIGMA_PER_MEDIAN: f64 = 1.4826;
/// Nearer pairs are always kept.
const TRIM_AT_LEAST_M: f64 = 1e-6;
/// A step shorter than this at the rim of the model ends it.
const STEP_M: f64 = 1e-8;
/// Below this share of the largest eigenvalue a direction counts as free.
const FREE_DIRECTION: f64 = 1e-4;

struct Pair {
    point: Point3<f64>,
    normal: Vector3<f64>,
    /// Along the normal.
    residual: f64,
}

/// Moves the model onto the truth from the given start, which must be nearer to the truth than to any other fit (ICP
/// descends to the next minimum). Points are spread evenly over the model with this seed; those far from the truth
/// (beyond three robust standard deviations) do not count, so that parts that the truth does not have pull nothing.
pub fn align(
    model: &TriangleMesh,
    truth: &TriangleMesh,
    start: &Isometry3<f64>,
    seed: u64,
) -> Result<Alignment, AlignError> {
    if !start.to_homogeneous().iter().all(|value| value.is_finite()) {
        return Err(AlignError::Start);
    }
    let index = MeshIndex::new(truth).map_err(CompareError::Truth)?;
    let samples = crate::sample_surface(model, SAMPLES, seed).map_err(CompareError::Model)?;
    if samples.is_empty() {
        return Err(CompareError::NoArea("model").into());
    }
    let mut alignment = Alignment {
        truth_from_model: *start,
        rms_mm: f64::NAN,
        kept_share: 0.0,
        iterations: 0,
        converged: false,
        observed_directions: 0,
    };
    for iteration in 1..=ITERATIONS {
        let kept = keep_near(pairs(&index, &samples, &alignment.truth_from_model));
        alignment.rms_mm = 1e3 * (kept.iter().map(|p| p.residual.powi(2)).sum::<f64>() / kept.len() as f64).sqrt();
        alignment.kept_share = kept.len() as f64 / samples.len() as f64;
        let step = step(&kept);
        alignment.observed_directions = step.observed_directions;
        alignment.iterations = iteration;
        if step.rim_m < STEP_M {
            alignment.converged = true;
            break;
        }
        alignment.truth_from_model = step.motion * alignment.truth_from_model;
    }
    Ok(alignment)
}

fn pairs(truth: &MeshIndex, samples: &[SurfaceSample], truth_from_model: &Isometry3<f64>) -> Vec<Pair> {
    let pair = |sample: &SurfaceSample| {
        let point = truth_from_model * sample.point;
        let closest = truth.closest(&point)?;
        let normal = truth.normal(closest.triangle);
        Some(Pair { point, normal, residual: normal.dot(&(point - closest.point)) })
    };
    samples.par_iter().filter_map(pair).collect()
}

fn keep_near(pairs: Vec<Pair>) -> Vec<Pair> {
    let mut sorted: Vec<f64> = pairs.iter().map(|p| p.residual.abs()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let median = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let limit = (TRIM_SIGMAS * SIGMA_PER_MEDIAN * median).max(TRIM_AT_LEAST_M);
    pairs.into_iter().filter(|p| p.residual.abs() <= limit).collect()
}

struct Step {
    motion: Isometry3<f64>,
    observed_directions: usize,
    /// How far it moves a point at the rim.
    rim_m: f64,
}

/// Gauss-Newton on the sum of squared residuals, turning about the middle of the points; rotations are measured by the
/// way they move the rim, so that all six unknowns are metres.
fn step(pairs: &[Pair]) -> Step {
    let count = pairs.len().max(1) as f64;
    let middle = Point3::from(pairs.iter().map(|p| p.point.coords).sum::<Vector3<f64>>() / count);
    let radius = (pairs.iter().map(|p| (p.point - middle).norm_squared()).sum::<f64>() / count).sqrt();
    let radius = if radius > 0.0 { radius } else { 1.0 };
    let mut normal_matrix = Matrix6::zeros();
    let mut right = Vector6::zeros();
    for pair in pairs {
        let turning = (pair.point - middle).cross(&pair.normal) / radius;
        let n = pair.normal;
        let row = Vector6::new(turning.x, turning.y, turning.z, n.x, n.y, n.z);
        normal_matrix.ger(1.0, &row, &row, 1.0);
        right -= row * pair.residual;
    }
    let eigen = SymmetricEigen::new(normal_matrix);
    let largest = eigen.eigenvalues.max();
    let mut solution = Vector6::zeros();
    let mut observed_directions = 0;
    for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > FREE_DIRECTION * largest && largest > 0.0 {
            observed_directions += 1;
            solution += direction * (direction.dot(&right) / value);
        }
    }
    let turn = UnitQuaternion::from_scaled_axis(solution.fixed_rows::<3>(0) / radius);
    let shift: Vector3<f64> = solution.fixed_rows::<3>(3).into();
    let about_middle = Isometry3::from_parts(Translation3::from(middle.coords + shift - turn * middle.coords), turn);
    Step { motion: about_middle, observed_directions, rim_m: solution.norm() }
}
