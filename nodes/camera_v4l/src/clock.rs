//! The monotonic clock, told on the system clock.

/// The system clock, read between two looks at the monotonic clock; nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClockReading {
    /// Monotonic, before.
    pub before: i64,
    /// System, since the epoch.
    pub system: i64,
    /// Monotonic, after.
    pub after: i64,
}

impl ClockReading {
    fn width(&self) -> i64 {
        self.after - self.before
    }

    fn middle(&self) -> i64 {
        self.before + self.width() / 2
    }
}

/// A reading that nothing interrupted is known so well, and better ones are not looked for.
const TIGHT_NANOS: i64 = 20_000;
/// After so long any reading is better than an old one: the system clock is steered (at most 500 in a million).
const OLD_NANOS: i64 = 1_000_000_000;

/// How far the system clock is ahead of the monotonic one. It is read again with every picture, because the system clock
/// is steered, and now and then set.
///
/// ```
/// use camera_v4l::{ClockMap, ClockReading};
/// let mut clock = ClockMap::default();
/// // The second reading was interrupted for a millisecond: it is not believed.
/// clock.update(&[ClockReading { before: 1000, system: 5_000_500, after: 2000 }]);
/// clock.update(&[ClockReading { before: 9000, system: 5_900_000, after: 1_009_000 }]);
/// assert_eq!(clock.system_nanos(7000), Some(5_006_000));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ClockMap {
    known: Option<ClockReading>,
}

impl ClockMap {
    /// Takes readings of just now, of which the tightest counts.
    pub fn update(&mut self, readings: &[ClockReading]) {
        let Some(best) = readings.iter().filter(|reading| reading.width() >= 0).min_by_key(|reading| reading.width())
        else {
            return;
        };
        let good = self.known.is_none_or(|known| {
            best.width() <= known.width().max(TIGHT_NANOS) || best.before - known.after > OLD_NANOS
        });
        if good {
            self.known = Some(*best);
        }
    }

    /// A moment of the monotonic clock on the system clock; none before the first reading.
    pub fn system_nanos(&self, monotonic_nanos: i64) -> Option<i64> {
        self.known.map(|known| known.system + (monotonic_nanos - known.middle()))
    }

    /// How uncertain that is.
    pub fn uncertainty_nanos(&self) -> Option<i64> {
        self.known.map(|known| known.width() / 2)
    }
}
