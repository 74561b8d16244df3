//! One part of the pose, position or rotation, over all runs of readings.

use super::choose::choose;
use super::outliers::{self, Known};
use super::run::{Run, Sample, Spline};
use super::{Silence, Smoothing};
use nalgebra::{SVector, Vector3};

/// A spline over each run of readings.
#[derive(Debug, Clone)]
pub(super) struct Track<const D: usize> {
    stretches: Vec<Stretch<D>>,
    pub lambda: f64,
    /// One standard deviation of the readings' white noise along three axes.
    pub sigma: Vector3<f64>,
    pub silences: Vec<Silence>,
    pub outliers: usize,
    pub stranded: usize,
}

#[derive(Debug, Clone)]
struct Stretch<const D: usize> {
    first_nanos: i64,
    last_nanos: i64,
    spline: Spline<D>,
}

/// Fewer readings are no run.
pub(super) const LEAST_READINGS: usize = 8;
/// The spline goes on across a shorter silence, though it is not asked there: what lies before it tells of what follows.
pub(super) const SPLIT_NANOS: u64 = 1_000_000_000;

impl<const D: usize> Track<D> {
    /// `axes` turns a value of the spline and a residual into the error along three axes. `None` when there is no run.
    pub(super) fn fit(
        samples: Vec<Sample<D>>,
        config: &Smoothing,
        axes: impl Fn(&SVector<f64, D>, &SVector<f64, D>) -> Vector3<f64>,
    ) -> Option<Self> {
        let readings = samples.len();
        let mut runs: Vec<Run<D>> = samples
            .chunk_by(|a, b| b.stamp_nanos.abs_diff(a.stamp_nanos) <= SPLIT_NANOS)
            .filter(|run| run.len() >= LEAST_READINGS)
            .filter_map(|run| Run::new(run.to_vec(), config.knot_nanos(), i64::MIN))
            // Readings that all but coincide hold no curve.
            .filter(|run| run.solve(1.0).is_some())
            .collect();
        runs.iter_mut().for_each(|run| outliers::mark_gross(run, config.outlier_sigmas, Known::NOTHING));
        let lambda = choose(&runs)?;
        let left_out =
            |runs: &[Run<D>]| -> Vec<bool> { runs.iter().flat_map(|r| r.samples()).map(|s| !s.active).collect() };
        let gross = left_out(&runs);
        let known = Known::from(&runs, lambda);
        for run in &mut runs {
            outliers::mark(run, lambda, config.outlier_sigmas, known);
        }
        let lambda = if left_out(&runs) == gross { lambda } else { choose(&runs)? };
        let (mut squares, mut own, mut used) = (Vector3::zeros(), 0.0, 0);
        let mut stretches = Vec::with_capacity(runs.len());
        let mut stamps = Vec::with_capacity(readings);
        for run in &runs {
            let Some(spline) = run.solve(lambda) else { continue };
            let active = || run.samples().iter().zip(run.residuals(&spline)).filter(|(sample, _)| sample.active);
            for (sample, residual) in active() {
                let off = axes(&(sample.value - residual.off), &residual.off);
                squares += off.component_mul(&off) * sample.weight;
                own += residual.own_share();
            }
            let from = stamps.len();
            stamps.extend(active().map(|(sample, _)| sample.stamp_nanos));
            let (Some(&first_nanos), Some(&last_nanos)) = (stamps.get(from), stamps.last()) else { continue };
            used += run.samples().len();
            stretches.push(Stretch { first_nanos, last_nanos, spline });
        }
        Some(Self {
            stretches,
            lambda,
            sigma: (squares / own).map(f64::sqrt),
            silences: silences(&stamps, config.most_gap_nanos()),
            outliers: used - stamps.len(),
            stranded: readings - used,
        })
        .filter(|track| !track.stretches.is_empty())
    }

    /// The spline that holds at a moment: `None` outside and where readings were silent.
    pub(super) fn spline(&self, stamp_nanos: i64) -> Option<&Spline<D>> {
        let stretch = self.stretches.get(self.stretches.partition_point(|s| s.last_nanos < stamp_nanos))?;
        let silence = self.silences.get(self.silences.partition_point(|s| s.until_nanos <= stamp_nanos));
        let silent = silence.is_some_and(|s| s.from_nanos < stamp_nanos);
        (stretch.first_nanos <= stamp_nanos && !silent).then_some(&stretch.spline)
    }

    /// First and last reading.
    pub(super) fn span_nanos(&self) -> Option<(i64, i64)> {
        Some((self.stretches.first()?.first_nanos, self.stretches.last()?.last_nanos))
    }
}

fn silences(stamps: &[i64], most_gap_nanos: i64) -> Vec<Silence> {
    let far = |pair: &&[i64]| pair[1].abs_diff(pair[0]) > most_gap_nanos.unsigned_abs();
    stamps.windows(2).filter(far).map(|pair| Silence { from_nanos: pair[0], until_nanos: pair[1] }).collect()
}
