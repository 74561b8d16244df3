//! The clock by which arrivals are told.

use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// A clock that never steps, so that a correction of the system clock does not look like jitter of the line. It starts
/// at 0 when it is made; copies tell the same time.
#[derive(Debug, Clone, Copy)]
pub struct HostClock {
    zero: Instant,
}

impl HostClock {
    /// Starts now.
    pub fn start() -> Self {
        Self { zero: Instant::now() }
    }

    /// Nanoseconds since its start.
    pub fn now_nanos(&self) -> i64 {
        self.zero.elapsed().as_nanos() as i64
    }

    /// A moment of this clock on the system clock as it stands now, in nanoseconds since the epoch.
    pub fn system_nanos(&self, moment_nanos: i64) -> i64 {
        moment_nanos + self.ahead_nanos()
    }

    /// A moment of the system clock on this one, as they stand now.
    pub fn from_system(&self, system_nanos: i64) -> i64 {
        system_nanos - self.ahead_nanos()
    }

    fn ahead_nanos(&self) -> i64 {
        let system = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as i64);
        system - self.now_nanos()
    }
}
