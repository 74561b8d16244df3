//! Readings that fit nowhere: far from the spline that all others make.

use super::choose::studentised;
use super::run::{Run, Sample, Spline};

/// The median length of a vector of three unit Gaussians.
const MEDIAN_LENGTH: f64 = 1.538;
/// The noise is taken over so many readings, because it grows with the distance from the tracker's base.
const BLOCK: usize = 128;
/// An outlier bends the spline around it, so of so many readings to either side only the farthest off is judged at once.
const NEIGHBOURS: usize = 25;
const ROUNDS: usize = 8;
/// Noise below this (metres, or halves of radians) is rounding.
const LEAST_NOISE: f64 = 1e-7;

/// Slower than any tremor: a spline of this stiffness does not follow two or three outliers in a row.
const STIFF_HZ: f64 = 3.0;

/// Marks what is far even from a stiff spline, whatever lambda will be: outliers would choose a lambda that follows them.
pub(super) fn mark_gross<const D: usize>(run: &mut Run<D>, outlier_sigmas: f64, known_noise: f64) {
    mark(run, run.lambda_of(STIFF_HZ), outlier_sigmas, known_noise);
}

/// Marks the outliers of a run as not active, takes back in what was only bent by another, and returns the spline
/// through the rest. The noise is at least `known_noise`, in the units of the values.
pub(super) fn mark<const D: usize>(
    run: &mut Run<D>,
    lambda: f64,
    outlier_sigmas: f64,
    known_noise: f64,
) -> Option<Spline<D>> {
    let mut spline = run.solve(lambda)?;
    for _ in 0..ROUNDS {
        let off = far_off(run, &spline, outlier_sigmas, known_noise.max(LEAST_NOISE));
        let farthest: Vec<usize> = (0..off.len()).filter(|&i| leads(&run.samples, &off, i)).collect();
        let bent: Vec<usize> = (0..off.len()).filter(|&i| !run.samples[i].active && off[i] == 0.0).collect();
        if farthest.is_empty() && bent.is_empty() {
            break;
        }
        farthest.iter().for_each(|&i| run.samples[i].active = false);
        // Only at the end, or the next farthest might be bent back.
        if farthest.is_empty() {
            bent.iter().for_each(|&i| run.samples[i].active = true);
        }
        spline = run.solve(lambda)?;
        if farthest.is_empty() {
            break;
        }
    }
    Some(spline)
}

/// By how much each reading is beyond the bound, in noise; 0 within it.
fn far_off<const D: usize>(run: &Run<D>, spline: &Spline<D>, outlier_sigmas: f64, known_noise: f64) -> Vec<f64> {
    let samples = &run.samples;
    let residuals: Vec<_> = run.residuals(spline).collect();
    let lengths: Vec<f64> = samples.iter().zip(&residuals).map(|(s, r)| studentised(s.weight, r)).collect();
    let noise = |lengths: &[f64]| {
        let mut lengths = lengths.to_vec();
        let middle = lengths.len() / 2;
        *lengths.select_nth_unstable_by(middle, f64::total_cmp).1 / MEDIAN_LENGTH
    };
    let least = noise(&lengths).max(known_noise);
    let blocks: Vec<f64> = lengths.chunks(BLOCK).map(|block| noise(block).max(least)).collect();
    let beyond = |i: usize| {
        let sample = &samples[i];
        // A left-out reading is compared with a spline that knows nothing of it.
        let unsure = if sample.active { 0.0 } else { spline.variance(sample.stamp_nanos).unwrap_or(0.0) };
        let sigmas = lengths[i] / (blocks[i / BLOCK] * (1.0 + sample.weight * unsure).sqrt());
        if sigmas > outlier_sigmas && residuals[i].off.norm() > sample.stated { sigmas } else { 0.0 }
    };
    (0..samples.len()).map(beyond).collect()
}

/// True for the farthest off among its neighbours that are not marked yet.
fn leads<const D: usize>(samples: &[Sample<D>], off: &[f64], i: usize) -> bool {
    let around = i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(off.len());
    off[i] > 0.0 && samples[i].active && around.into_iter().all(|k| off[k] <= off[i] || !samples[k].active)
}
