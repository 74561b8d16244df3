//! Position or rotation at some moments, from the readings around them.

use super::outliers::{self, Known};
use super::run::{Run, Sample, Spline};
use super::track::{LEAST_READINGS, SPLIT_NANOS, Track};
use super::{Smoothing, readings};
use nalgebra::SVector;

/// Readings so long before the moment have their say; older ones tell less than a thousandth.
pub(super) const WINDOW_NANOS: i64 = 1_000_000_000;

/// From so few readings no spline comes nearer to a hand's way (metres, or halves of radians): a better tracker's readings
/// are no outliers for that.
const LEAST_MISFIT: f64 = 3e-5;
/// The same of a spline that does not follow a hand that turns back.
const STIFF_MISFIT: f64 = 3e-4;

/// How stiff the spline is, and how noisy the readings are on each axis (metres or radians).
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    lambda: f64,
    sigma: f64,
}

/// The spline through the readings around some moments.
pub(super) struct Fit<const D: usize> {
    run: Run<D>,
    spline: Spline<D>,
}

/// At the moment that was asked.
pub(super) struct Found<const D: usize> {
    pub value: SVector<f64, D>,
    /// In units of a reading's.
    pub variance: f64,
    /// The reading before or behind the moment fits nowhere.
    pub beside_outlier: bool,
}

impl Part {
    pub(super) fn tuned<const D: usize>(track: &Track<D>) -> Self {
        Self { lambda: track.lambda, sigma: readings::rms(&track.sigma) }
    }

    /// For moments up to `last_nanos`. `None` when the readings are too few or too long ago.
    pub(super) fn fit<const D: usize>(
        &self,
        samples: Vec<Sample<D>>,
        last_nanos: i64,
        config: &Smoothing,
    ) -> Option<Fit<D>> {
        let ahead = last_nanos.saturating_sub(samples.last()?.stamp_nanos);
        if samples.len() < LEAST_READINGS || ahead > WINDOW_NANOS {
            return None;
        }
        // A quaternion is off by half the angle.
        let noise = if D == 4 { 0.5 * self.sigma } else { self.sigma };
        let [stiff, known] =
            [STIFF_MISFIT, LEAST_MISFIT].map(|misfit| Known { least: noise.max(misfit), ..Known::NOTHING });
        let mut run = Run::new(samples, config.knot_nanos(), last_nanos)?;
        outliers::mark_gross(&mut run, config.outlier_sigmas, stiff);
        let spline = outliers::mark(&mut run, self.lambda, config.outlier_sigmas, known)?;
        Some(Fit { run, spline })
    }

    /// One standard deviation of a pose of this variance. What the tracker states beyond its white noise changes slowly,
    /// so smoothing leaves it.
    pub(super) fn sigma(&self, variance: f64, stated: f64) -> f64 {
        let white = self.sigma * self.sigma;
        let slow = if stated.is_finite() { (stated * stated - white).max(0.0) } else { 0.0 };
        (variance * white + slow).sqrt()
    }
}

impl<const D: usize> Fit<D> {
    pub(super) fn at(&self, stamp_nanos: i64) -> Option<Found<D>> {
        let samples = self.run.samples();
        let behind = samples.partition_point(|s| s.stamp_nanos < stamp_nanos);
        let beside_outlier = samples[behind.saturating_sub(1)..].iter().take(2).any(|sample| !sample.active);
        Some(Found {
            value: self.spline.at(stamp_nanos)?,
            variance: self.spline.variance(stamp_nanos)?,
            beside_outlier,
        })
    }
}

/// Those readings that no long silence separates from the moment.
pub(super) fn around<const D: usize>(samples: Vec<Sample<D>>, stamp_nanos: i64) -> Vec<Sample<D>> {
    let together = |a: &Sample<D>, b: &Sample<D>| b.stamp_nanos.abs_diff(a.stamp_nanos) <= SPLIT_NANOS;
    let holds = |row: &&[Sample<D>]| row.last().is_some_and(|last| last.stamp_nanos >= stamp_nanos);
    let mut rows = samples.chunk_by(together);
    let row = rows.clone().find(holds).or_else(|| rows.next_back());
    row.map(<[_]>::to_vec).unwrap_or_default()
}
