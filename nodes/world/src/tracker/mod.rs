//! The tracker's errors.

use serde::Deserialize;

/// `[simulation.tracker]` of a rig file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrackerSection {
    /// Readings a second.
    pub rate_hz: f64,
}

impl Default for TrackerSection {
    fn default() -> Self {
        Self { rate_hz: 100.0 }
    }
}
