//! Readings that fit nowhere: far from the spline that all others make.

use super::choose::studentised;
use super::run::{Residual, Run, Sample, Spline};

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
/// Noise beyond so many times that of the noisier readings of a scan is no noise,
const MOST_NOISE: f64 = 4.0;
/// where this share of the blocks is less noisy.
const NOISIER: f64 = 0.9;

/// What is known of the noise before, in the units of the values: at least, and at most.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known {
    pub least: f64,
    pub most: f64,
}

impl Known {
    pub(super) const NOTHING: Self = Self { least: 0.0, most: f64::INFINITY };

    /// From the noise of all runs, so that one that is all outliers is known by the others.
    pub(super) fn from<const D: usize>(runs: &[Run<D>], lambda: f64) -> Self {
        let blocks_of = |run: &Run<D>| run.solve(lambda).map(|spline| blocks(&lengths(run, run.residuals(&spline))));
        let mut all: Vec<f64> = runs.iter().filter_map(blocks_of).flatten().collect();
        all.sort_unstable_by(f64::total_cmp);
        let noisier = all.get((all.len() as f64 * NOISIER) as usize).copied();
        Self { least: 0.0, most: noisier.map_or(f64::INFINITY, |noise| MOST_NOISE * noise) }
    }
}

/// Marks what is far even from a stiff spline, whatever lambda will be: outliers would choose a lambda that follows them.
pub(super) fn mark_gross<const D: usize>(run: &mut Run<D>, outlier_sigmas: f64, known: Known) {
    mark(run, run.lambda_of(STIFF_HZ), outlier_sigmas, known);
}

/// Marks the outliers of a run as not active, takes back in what was only bent by another, and returns the spline
/// through the rest.
pub(super) fn mark<const D: usize>(
    run: &mut Run<D>,
    lambda: f64,
    outlier_sigmas: f64,
    known: Known,
) -> Option<Spline<D>> {
    let mut spline = run.solve(lambda)?;
    for _ in 0..ROUNDS {
        let off = far_off(run, &spline, outlier_sigmas, known);
        let farthest: Vec<usize> = (0..off.len()).filter(|&i| leads(run.samples(), &off, i)).collect();
        let bent: Vec<usize> = (0..off.len()).filter(|&i| !run.samples()[i].active && off[i] == 0.0).collect();
        if farthest.is_empty() && bent.is_empty() {
            break;
        }
        run.set_active(&farthest, false);
        // Only at the end, or the next farthest might be bent back.
        if farthest.is_empty() {
            run.set_active(&bent, true);
        }
        spline = run.solve(lambda)?;
        if farthest.is_empty() {
            break;
        }
    }
    Some(spline)
}

/// How far off each reading is, whatever its own weight.
fn lengths<const D: usize>(run: &Run<D>, residuals: impl Iterator<Item = Residual<D>>) -> Vec<f64> {
    run.samples().iter().zip(residuals).map(|(sample, r)| studentised(sample.weight, &r)).collect()
}

/// One standard deviation of the noise on each axis, block by block.
fn blocks(lengths: &[f64]) -> Vec<f64> {
    let noise = |lengths: &[f64]| {
        let mut lengths = lengths.to_vec();
        let middle = lengths.len() / 2;
        *lengths.select_nth_unstable_by(middle, f64::total_cmp).1 / MEDIAN_LENGTH
    };
    let overall = noise(lengths);
    lengths.chunks(BLOCK).map(|block| noise(block).max(overall)).collect()
}

/// By how much each reading is beyond the bound, in noise; 0 within it.
fn far_off<const D: usize>(run: &Run<D>, spline: &Spline<D>, outlier_sigmas: f64, known: Known) -> Vec<f64> {
    let residuals: Vec<Residual<D>> = run.residuals(spline).collect();
    let lengths = lengths(run, residuals.iter().copied());
    let blocks = blocks(&lengths);
    let beyond = |(i, (sample, residual)): (usize, (&Sample<D>, &Residual<D>))| {
        // A left-out reading is compared with a spline that knows nothing of it.
        let unsure = if sample.active { 0.0 } else { spline.variance(sample.stamp_nanos).unwrap_or(0.0) };
        let noise = blocks[i / BLOCK].min(known.most).max(known.least).max(LEAST_NOISE);
        let sigmas = lengths[i] / (noise * (1.0 + sample.weight * unsure).sqrt());
        if sigmas > outlier_sigmas && residual.off.norm() > sample.stated { sigmas } else { 0.0 }
    };
    run.samples().iter().zip(&residuals).enumerate().map(beyond).collect()
}

/// True for the farthest off among its neighbours that are not marked yet.
fn leads<const D: usize>(samples: &[Sample<D>], off: &[f64], i: usize) -> bool {
    let around = i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(off.len());
    off[i] > 0.0 && samples[i].active && around.into_iter().all(|k| off[k] <= off[i] || !samples[k].active)
}
