//! A device's own clock, told in ours.

use crate::{Envelope, Undelayed};

const WINDOW_NANOS: f64 = 8e9;
const SETTLED_NANOS: f64 = 1e9;
const SETTLED_COUNT: usize = 32;
/// A crystal is good to 100 parts in a million; what differs more is a window of too few good arrivals.
const DRIFT_TOLERANCE: f64 = 5e-4;
/// A time stamp that strays so far from the arrivals is a bit error, or a clock that was set.
const STRAY_NANOS: f64 = 1e9;
/// So many of them in a row are a clock that was set.
const STRAY_STREAK: u32 = 3;

/// The map from a device's ticks (32 bits, wrapping) to our clock: the line under the arrivals over the ticks
/// ([`Envelope`]), which late arrivals cannot move. A tick stands for the middle of its length.
///
/// ```
/// let mut clock = serial_line::DeviceClock::new(1e6); // ticks of 1 ms
/// let mut error = 0.0;
/// for k in 0..2000_i64 {
///     let measured = 123_456_789 + k * 4_166_667; // 240 a second
///     let ticks = (measured / 1_000_000) as u32;
///     let arrival = measured + 2_000_000 + (k * 7919) % 10_000 * 1000; // 2 ms of delay, and 0 to 10 ms of jitter
///     let undelayed = clock.undelay(ticks, arrival).ok_or("a stray")?;
///     error = (undelayed.nanos - 2_000_000 - measured) as f64 * 1e-6;
/// }
/// assert!(error.abs() < 0.7, "{error} ms: half a tick, and what little jitter is left");
/// # Ok::<(), &str>(())
/// ```
#[derive(Debug, Clone)]
pub struct DeviceClock {
    envelope: Envelope,
    tick_nanos: f64,
    last: Option<(u32, i64)>,
    ticks: i64,
    strays: u32,
    last_nanos: i64,
    jitter: (f64, f64),
}

impl DeviceClock {
    /// A clock whose ticks last so long by their data sheet.
    pub fn new(tick_nanos: f64) -> Self {
        Self {
            envelope: Envelope::new(WINDOW_NANOS),
            tick_nanos,
            last: None,
            ticks: 0,
            strays: 0,
            last_nanos: i64::MIN,
            jitter: (0.0, 0.0),
        }
    }

    /// When a record with this time stamp would have arrived, had nothing delayed it; `None` for a time stamp that does
    /// not follow from those before it. Answers never fall behind the one before.
    pub fn undelay(&mut self, ticks: u32, arrival_nanos: i64) -> Option<Undelayed> {
        if let Some((last_ticks, last_arrival)) = self.last {
            let step = i64::from(ticks.wrapping_sub(last_ticks) as i32);
            let strays = (step as f64 * self.tick_nanos - (arrival_nanos - last_arrival) as f64).abs() > STRAY_NANOS;
            if strays || step < 0 {
                self.strays += 1;
                if self.strays < STRAY_STREAK {
                    return None;
                }
                self.envelope.clear();
                self.ticks = 0;
            } else {
                self.ticks += step;
            }
        }
        self.strays = 0;
        self.last = Some((ticks, arrival_nanos));
        self.envelope.push(self.ticks as f64, arrival_nanos as f64);
        let settled = self.envelope.count() >= SETTLED_COUNT && self.envelope.duration() >= SETTLED_NANOS;
        let line = settled.then(|| self.envelope.fit(None)).flatten();
        let plausible = |slope: f64| (slope / self.tick_nanos - 1.0).abs() < DRIFT_TOLERANCE;
        let line = match line.filter(|line| plausible(line.slope)) {
            Some(line) => line,
            None => self.envelope.fit(Some(self.tick_nanos))?,
        };
        self.jitter = self.envelope.scatter(&line);
        // The envelope touches the arrivals that were measured at the very start of their tick.
        let nanos = (line.at(self.ticks as f64) + 0.5 * self.tick_nanos) as i64;
        self.last_nanos = nanos.max(self.last_nanos);
        Some(Undelayed { nanos: self.last_nanos, removed_nanos: arrival_nanos - self.last_nanos, settled })
    }

    /// The jitter that was taken away from the arrivals of the last seconds, the coarseness of the ticks included: root
    /// mean square about its mean, and the most, in nanoseconds.
    pub fn jitter_nanos(&self) -> (f64, f64) {
        self.jitter
    }
}
