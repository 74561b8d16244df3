//! When a source may send: in real time, or as fast as the slowest of its consumers.

use serde::{Deserialize, Serialize};
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use wire::Phase;

/// How simulated and replayed sources keep time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pace {
    /// As it would be with real devices; who cannot follow loses messages, and they are counted.
    #[default]
    Real,
    /// As fast as the machine can, with nothing lost.
    Fast,
}

/// The operator has said go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Go {
    /// Which scan.
    pub scan: u64,
    /// In which phase.
    pub phase: Phase,
    /// The system clock when the scan's own clock stood at 0.
    pub epoch_nanos: i64,
}

/// Now, on the system clock.
pub(crate) fn system_nanos() -> i64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_nanos() as i64)
}

/// How long a source at real pace still has to wait for a stamp; `None` when its time has come.
pub(crate) fn until(epoch_nanos: i64, stamp_nanos: i64) -> Option<Duration> {
    let left = epoch_nanos.saturating_add(stamp_nanos).saturating_sub(system_nanos());
    (left > 0).then(|| Duration::from_nanos(left as u64))
}
