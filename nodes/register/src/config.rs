//! How long is waited, and across which gaps is interpolated.

use geometry::Wait;
use serde::{Deserialize, Serialize};

/// The bounds. Milliseconds, because people write them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Readings further apart are not interpolated between: the hand may have been anywhere.
    pub most_gap_ms: f64,
    /// A profile is refused when the tracker is silent for so long behind it (on the clock of newer profiles).
    pub most_wait_ms: f64,
    /// So many profiles may wait for a reading; then the oldest is refused.
    pub most_waiting: usize,
    /// The pose is the one of a smooth way through the readings; else it is interpolated between two of them.
    pub smooth: bool,
    /// The smooth pose waits for readings so long behind the profile: the later, the steadier. At most 200 ms, because a
    /// source at fast pace runs no farther than 400 ms ahead.
    pub smooth_lag_ms: f64,
    /// With no lag, the smooth pose is taken from readings up to so long before the profile when they tell it better than
    /// the next reading would: so a profile need not wait for a noisy tracker. Each 5 ms cost 0.1 mm and 0.1 degrees with
    /// the paper's tracker.
    pub predict_ms: f64,
    /// Readings of degraded quality are used as well, with the sigma that they state.
    pub use_degraded: bool,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            most_gap_ms: 100.0,
            most_wait_ms: 60_000.0,
            most_waiting: 4096,
            smooth: true,
            smooth_lag_ms: 0.0,
            predict_ms: 5.0,
            use_degraded: true,
        }
    }
}

/// A bound that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("register: {key} = {value}: {wanted}")]
pub struct ConfigError {
    /// The key.
    pub key: &'static str,
    /// What it holds.
    pub value: f64,
    /// What it should hold.
    pub wanted: &'static str,
}

impl Config {
    /// Refuses what makes no sense.
    pub fn check(&self) -> Result<(), ConfigError> {
        for (key, value, bounds, wanted) in [
            ("most_gap_ms", self.most_gap_ms, 1.0..=1e6, "1 ms to 1000 s"),
            ("most_wait_ms", self.most_wait_ms, 1.0..=1e6, "1 ms to 1000 s"),
            ("smooth_lag_ms", self.smooth_lag_ms, 0.0..=200.0, "0 to 200 ms"),
            ("predict_ms", self.predict_ms, 0.0..=50.0, "0 to 50 ms"),
        ] {
            if !bounds.contains(&value) {
                return Err(ConfigError { key, value, wanted });
            }
        }
        if self.most_waiting == 0 {
            return Err(ConfigError { key: "most_waiting", value: 0.0, wanted: "at least 1" });
        }
        Ok(())
    }

    pub(crate) fn wait(&self) -> Wait {
        let predict_ms = if self.smooth_lag_ms > 0.0 { 0.0 } else { self.predict_ms };
        Wait { lag_nanos: (self.smooth_lag_ms * 1e6) as i64, predict_nanos: (predict_ms * 1e6) as i64 }
    }

    pub(crate) fn most_gap_nanos(&self) -> i64 {
        (self.most_gap_ms * 1e6) as i64
    }

    pub(crate) fn most_wait_nanos(&self) -> i64 {
        (self.most_wait_ms * 1e6) as i64
    }
}
