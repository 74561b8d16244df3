//! The clocks of this machine.

use crate::clock::ClockReading;
use rustix::time::{ClockId, clock_gettime};
use std::time::{SystemTime, UNIX_EPOCH};

/// Now, by the clock that drivers stamp with.
pub fn monotonic_nanos() -> i64 {
    let now = clock_gettime(ClockId::Monotonic);
    now.tv_sec * 1_000_000_000 + now.tv_nsec
}

/// Both clocks, a few times in a row: one reading or another is not interrupted.
pub fn clock_readings() -> [ClockReading; 3] {
    std::array::from_fn(|_| {
        let before = monotonic_nanos();
        let system = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as i64);
        ClockReading { before, system, after: monotonic_nanos() }
    })
}
