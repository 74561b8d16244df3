//! How long is waited, and across which gaps is interpolated.

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
    /// Readings of degraded quality are used as well, with the sigma that they state.
    pub use_degraded: bool,
}

impl Default for Config {
    fn default() -> Self {
        Self { most_gap_ms: 100.0, most_wait_ms: 60_000.0, most_waiting: 4096, use_degraded: true }
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
        for (key, value) in [("most_gap_ms", self.most_gap_ms), ("most_wait_ms", self.most_wait_ms)] {
            if !(value > 0.0 && value <= 1e6) {
                return Err(ConfigError { key, value, wanted: "more than 0 and at most 1000 s" });
            }
        }
        if self.most_waiting == 0 {
            return Err(ConfigError { key: "most_waiting", value: 0.0, wanted: "at least 1" });
        }
        Ok(())
    }

    pub(crate) fn most_gap_nanos(&self) -> i64 {
        (self.most_gap_ms * 1e6) as i64
    }

    pub(crate) fn most_wait_nanos(&self) -> i64 {
        (self.most_wait_ms * 1e6) as i64
    }
}
