//! How stiff the spline is: the lambda whose spline, made without a reading, comes nearest to that reading (Craven and
//! Wahba 1979). The leave-one-out error needs no second fit: it is residual / (1 - leverage).

use super::run::{Residual, Run};

/// Decades of lambda that are tried, in halves: from a spline through every reading to one over several seconds. Beyond
/// lies what no hand does, and where digits are lost.
const LOWEST: f64 = -3.0;
const STEPS: usize = 23;
const STEP: f64 = 0.5;
/// Errors beyond so many medians count as if they were this large, so that outliers do not choose.
const CAP: f64 = 3.0;

/// The lambda for all runs together; `None` when nothing can be solved.
pub(super) fn choose<const D: usize>(runs: &[Run<D>]) -> Option<f64> {
    let score = |step: usize| score(runs, decade(step as f64)).unwrap_or(f64::INFINITY);
    let scores: Vec<f64> = (0..STEPS).map(score).collect();
    let best = (0..STEPS).min_by(|&a, &b| scores[a].total_cmp(&scores[b])).filter(|&i| scores[i].is_finite())?;
    Some(decade(best as f64 + vertex(&scores, best)))
}

fn decade(step: f64) -> f64 {
    10f64.powf(LOWEST + STEP * step)
}

/// Where the parabola through the best score and its neighbours is least, -0.5..0.5 steps off.
fn vertex(scores: &[f64], best: usize) -> f64 {
    let (Some(left), Some(right)) = (best.checked_sub(1).map(|i| scores[i]), scores.get(best + 1)) else { return 0.0 };
    let (left, middle, right) = (left.ln(), scores[best].ln(), right.ln());
    let shift = 0.5 * (left - right) / (left - 2.0 * middle + right);
    if shift.is_finite() { shift.clamp(-0.5, 0.5) } else { 0.0 }
}

/// The mean square leave-one-out error.
fn score<const D: usize>(runs: &[Run<D>], lambda: f64) -> Option<f64> {
    let mut squares = Vec::with_capacity(runs.iter().map(|run| run.samples().len()).sum());
    for run in runs {
        // A run that lost too many readings as outliers says nothing.
        let Some(spline) = run.solve(lambda) else { continue };
        let active = run.samples().iter().zip(run.residuals(&spline)).filter(|(sample, _)| sample.active);
        squares.extend(active.map(|(sample, r)| sample.weight * r.off.norm_squared() / r.own_share().powi(2)));
    }
    let count = squares.len();
    let (_, median, _) = (count > 0).then(|| squares.select_nth_unstable_by(count / 2, f64::total_cmp))?;
    let cap = CAP * CAP * *median;
    // A floor, because the logarithm of nothing chooses nothing.
    Some(squares.iter().map(|square| square.min(cap)).sum::<f64>() / count as f64 + f64::MIN_POSITIVE)
}

/// How far a reading is off, in units in which the white noise of all readings has one size (studentised residual).
pub(super) fn studentised<const D: usize>(weight: f64, residual: &Residual<D>) -> f64 {
    (weight * residual.off.norm_squared() / residual.own_share()).sqrt()
}
