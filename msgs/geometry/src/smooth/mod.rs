//! From noisy readings of a tracker to a smooth way.
//!
//! Position and rotation each are a cubic B-spline with knots at equal distances: three components for the position,
//! four for the quaternion, whose signs are made continuous and whose length is made one again when it is asked. The
//! control points minimise the squared distance to the readings plus lambda times their squared third differences
//! (Eilers and Marx 1996): a hand moves with bounded jerk, noise does not. How much is chosen by leave-one-out
//! cross-validation (Craven and Wahba 1979), for position and rotation apart. The readings' white noise comes out of it:
//! the sum of squared residuals over the readings less the spline's degrees of freedom. All is banded, so time grows
//! linearly with the readings.
//!
//! [`SmoothTrajectory`] goes through all readings of a scan; [`FixedLagSmoother`] answers while they come, from the
//! readings of the last second, with the stiffness and noise of the last four.
//!
//! What no smoothing can do: errors that change as slowly as the hand moves stay, and are in none of the sigmas here.
//!
//! ```
//! use geometry::{SmoothTrajectory, Smoothing, TimedPose};
//! use nalgebra::Isometry3;
//! let reading = |i: i64| {
//!     let (t, jitter) = (i as f64 * 0.01, 4e-3 * ((i * i * 7919 % 1009) as f64 / 1009.0 - 0.5));
//!     let pose = Isometry3::translation(0.1 * t.sin() + jitter, 0.0, 0.2);
//!     TimedPose { stamp_nanos: i * 10_000_000, pose, position_sigma_m: 1e-3, rotation_sigma_rad: 0.01 }
//! };
//! let readings: Vec<TimedPose> = (0..300).map(reading).collect();
//! let way = SmoothTrajectory::fit(&readings, &Smoothing::default()).unwrap();
//! let pose = way.at(1_505_000_000).unwrap();
//! assert!((pose.translation.x - 0.1 * 1.505_f64.sin()).abs() < 0.3e-3);
//! assert!(way.at(-1).is_none() && way.gaps().is_empty());
//! ```

mod answer;
mod band;
mod basis;
mod choose;
mod fixed_lag;
mod order;
mod outliers;
mod part;
mod readings;
mod run;
mod track;
mod trajectory;

pub use fixed_lag::{FixedLagSmoother, Wait};
pub use trajectory::SmoothTrajectory;

use serde::{Deserialize, Serialize};

/// How readings are smoothed. How much is chosen by the readings themselves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Smoothing {
    /// Between two knots. The tremor of a hand has up to 12 Hz, which knots of 50 ms cannot follow: a tracker of 0.05 mm
    /// comes out at 0.03 mm with 20 ms and at 0.2 mm with 50. Stiffness is lambda's business, so a noisy tracker gains
    /// nothing by wider ones.
    pub knot_ms: f64,
    /// There is no pose where the readings were silent for longer: the hand may have been anywhere.
    pub most_gap_ms: f64,
    /// A reading farther from the spline than so many standard deviations of its like is left out.
    pub outlier_sigmas: f64,
}

impl Default for Smoothing {
    fn default() -> Self {
        Self { knot_ms: 20.0, most_gap_ms: 100.0, outlier_sigmas: 6.0 }
    }
}

impl Smoothing {
    /// Refuses what makes no sense.
    pub fn check(&self) -> Result<(), SmoothError> {
        let bounds = [
            ("knot_ms", self.knot_ms, 1.0, 1e3, "1 to 1000 ms"),
            ("most_gap_ms", self.most_gap_ms, 1.0, 1e6, "1 ms to 1000 s"),
            ("outlier_sigmas", self.outlier_sigmas, 3.0, 1e6, "at least 3, or noise is thrown away"),
        ];
        match bounds.into_iter().find(|(_, value, least, most, _)| !(*least..=*most).contains(value)) {
            Some((key, value, _, _, wanted)) => Err(SmoothError::Config { key, value, wanted }),
            None => Ok(()),
        }
    }

    fn knot_nanos(&self) -> i64 {
        (self.knot_ms * 1e6) as i64
    }

    fn most_gap_nanos(&self) -> i64 {
        (self.most_gap_ms * 1e6) as i64
    }
}

/// Why there is no smooth way.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SmoothError {
    /// The settings.
    #[error("smoothing: {key} = {value}: {wanted}")]
    Config {
        /// The key.
        key: &'static str,
        /// What it holds.
        value: f64,
        /// What it should hold.
        wanted: &'static str,
    },
    /// No row of readings is long enough.
    #[error("{usable} readings are too few or too scattered to be smoothed; {needed} in a row are needed")]
    TooFew {
        /// Finite readings in the order of time.
        usable: usize,
        /// In one run.
        needed: usize,
    },
    /// Two scans in one, or a broken clock.
    #[error("the time of {count} of {of} readings goes backwards; are these readings of one tracker and one scan?")]
    Backwards {
        /// So many do not fit into the order.
        count: usize,
        /// Of so many.
        of: usize,
    },
}

/// What became of the readings.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SmoothCounts {
    /// All that were given.
    pub readings: usize,
    /// Left out: not finite, or no rotation.
    pub not_finite: usize,
    /// Left out: not later than those before.
    pub backwards: usize,
    /// Left out: too few in a row, with silence of more than a second to either side.
    pub stranded: usize,
    /// Left out of the position: far from all others.
    pub position_outliers: usize,
    /// Left out of the rotation: far from all others.
    pub rotation_outliers: usize,
}

/// A time without readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Silence {
    /// The last reading before it.
    pub from_nanos: i64,
    /// The first reading behind it.
    pub until_nanos: i64,
}

impl Silence {
    /// In order, those that overlap made one.
    fn joined(mut silences: Vec<Self>) -> Vec<Self> {
        silences.sort_unstable();
        silences.dedup_by(|later, earlier| {
            let overlap = later.from_nanos < earlier.until_nanos;
            if overlap {
                earlier.until_nanos = earlier.until_nanos.max(later.until_nanos);
            }
            overlap
        });
        silences
    }
}
