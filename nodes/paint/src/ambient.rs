//! Light that does not come from the lamp, found from the pictures themselves.
//!
//! A cell seen from several distances and angles gives light L = albedo (E + A), with E by the lamp, known, and A around.
//! Under the right A all views of a cell agree on its albedo. Where poses and normals are too coarse for E to mean
//! much, the best A is large, and the views are simply averaged: the correction is as strong as it helps.

use crate::sample::{Sample, median};
use rayon::prelude::*;

/// Cells with fewer estimates say nothing of their spread.
const ESTIMATES_MIN: usize = 3;
/// More cells than this are not asked.
const CELLS_MAX: usize = 6_000;
/// The steps on the way from no ambient light to four times the lamp, each by sqrt(2).
const STEPS: i32 = 21;
const SMALLEST: f32 = 1.0 / 256.0;
const REFINEMENTS: usize = 12;

/// Ambient light for each channel, as a share of the lamp's on a surface that faces it at 0.2 m. `samples` are those of
/// all cells, `per_cell` each. Zero when no cell was seen often enough.
pub fn estimate(samples: &[Sample], per_cell: usize) -> [f32; 3] {
    let enough = |cell: &&[Sample]| cell.iter().filter(|s| s.is_some()).count() >= ESTIMATES_MIN;
    let cells: Vec<&[Sample]> = samples.par_chunks(per_cell).filter(enough).collect();
    let step = cells.len().div_ceil(CELLS_MAX).max(1);
    let asked: Vec<&[Sample]> = cells.into_iter().step_by(step).collect();
    if asked.is_empty() {
        return [0.0; 3];
    }
    std::array::from_fn(|channel| least(|ambient| disagreement(&asked, channel, ambient)))
}

/// Where a function of the ambient light is least.
fn least(cost: impl Fn(f32) -> f64) -> f32 {
    let grid = |step: i32| if step < 0 { 0.0 } else { SMALLEST * 2f32.powf(step as f32 / 2.0) };
    let costs: Vec<f64> = (-1..STEPS).map(|step| cost(grid(step))).collect();
    let best = (0..costs.len()).min_by(|&a, &b| costs[a].total_cmp(&costs[b])).unwrap_or(0) as i32 - 1;
    let (mut low, mut high) = (grid(best - 1), grid((best + 1).min(STEPS - 1)));
    for _ in 0..REFINEMENTS {
        let third = (high - low) / 3.0;
        if cost(low + third) <= cost(high - third) { high -= third } else { low += third }
    }
    0.5 * (low + high)
}

/// Sum over the cells of how far their views are apart, in the logarithm of albedo.
fn disagreement(cells: &[&[Sample]], channel: usize, ambient: f32) -> f64 {
    const CHUNK: usize = 512;
    let of_cell = |cell: &&[Sample]| {
        let albedo = |s: &Sample| ((s.radiance()[channel] + 1e-5) / (s.irradiance() + ambient).max(1e-4)).ln();
        let values = || cell.iter().filter(|s| s.is_some()).map(albedo);
        let centre = median(values());
        values().map(|v| f64::from((v - centre).abs())).sum::<f64>()
    };
    // Summed chunk by chunk, so that the rounding does not depend on the number of threads.
    let sums: Vec<f64> = cells.par_chunks(CHUNK).map(|chunk| chunk.iter().map(of_cell).sum()).collect();
    sums.iter().sum()
}
