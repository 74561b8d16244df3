//! Readings that fit nowhere: far from the spline that all others make.

use super::choose::studentised;
use super::run::{Run, Spline};

/// The median length of a vector of three unit Gaussians.
const MEDIAN_LENGTH: f64 = 1.538;
/// The noise is taken over so many readings, because it grows with the distance from the tracker's base.
const BLOCK: usize = 128;
/// An outlier bends the spline around it, so of so many readings to either side only the farthest off is judged at once.
const NEIGHBOURS: usize = 25;
const ROUNDS: usize = 8;
/// Noise below this (metres, or halves of radians) is rounding.
const LEAST_NOISE: f64 = 1e-7;

/// Marks the outliers of a run as not active. Readings that were marked by the bend of another are taken back in.
pub(super) fn mark<const D: usize>(run: &mut Run<D>, lambda: f64, outlier_sigmas: f64) {
    for round in 1..=ROUNDS {
        let Some(spline) = run.solve(lambda) else { return };
        let off = far_off(run, &spline, outlier_sigmas);
        let farthest: Vec<usize> = (0..off.len()).filter(|&i| run.samples[i].active && leads(&off, i)).collect();
        if farthest.is_empty() || round == ROUNDS {
            for (sample, off) in run.samples.iter_mut().zip(&off) {
                sample.active |= *off == 0.0;
            }
            return;
        }
        farthest.into_iter().for_each(|i| run.samples[i].active = false);
    }
}

/// By how much each reading is beyond the bound, in noise; 0 within it.
fn far_off<const D: usize>(run: &Run<D>, spline: &Spline<D>, outlier_sigmas: f64) -> Vec<f64> {
    let residuals = || run.samples.iter().zip(run.residuals(spline));
    let lengths: Vec<f64> = residuals().map(|(sample, r)| studentised(sample.weight, &r)).collect();
    let noise = |lengths: &[f64]| {
        let mut lengths = lengths.to_vec();
        let middle = lengths.len() / 2;
        *lengths.select_nth_unstable_by(middle, f64::total_cmp).1 / MEDIAN_LENGTH
    };
    let overall = noise(&lengths);
    let blocks: Vec<f64> = lengths.chunks(BLOCK).map(|block| noise(block).max(overall).max(LEAST_NOISE)).collect();
    let beyond = |(i, (sample, r)): (usize, _)| -> f64 {
        let (sample, r): (&super::run::Sample<D>, super::run::Residual<D>) = (sample, r);
        // A left-out reading is compared with a spline that knows nothing of it.
        let unsure =
            if sample.active { 0.0 } else { sample.weight * spline.variance(sample.stamp_nanos).unwrap_or(0.0) };
        let sigmas = lengths[i] / (blocks[i / BLOCK] * (1.0 + unsure).sqrt());
        if sigmas > outlier_sigmas && r.off.norm() > sample.stated { sigmas } else { 0.0 }
    };
    residuals().enumerate().map(beyond).collect()
}

/// True for the farthest off among its neighbours.
fn leads(off: &[f64], i: usize) -> bool {
    let around = &off[i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(off.len())];
    off[i] > 0.0 && around.iter().all(|other| *other <= off[i])
}
