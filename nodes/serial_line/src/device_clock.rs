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
/// A step between two frames is known to a tick at either end.
const STEP_TICKS: f64 = 1.1;

/// The map from a device's ticks (32 bits, wrapping) to our clock: the line under the arrivals over the ticks
/// ([`Envelope`]), which late arrivals cannot move.
///
/// Ticks are coarse. A device that measures in even frames has better time than it tells: then the ticks count the
/// frames, and the line lies under the arrivals over the frames. Where steps are no whole frames, ticks stand for
/// themselves, each for the middle of its length.
///
/// ```
/// let mut clock = serial_line::DeviceClock::new(1e6, Some(1e9 / 240.0)); // ticks of 1 ms, 240 frames a second
/// let mut error = 0.0;
/// for k in 0..2000_i64 {
///     let measured = 123_456_789 + k * 4_166_667;
///     let ticks = (measured / 1_000_000) as u32;
///     let arrival = measured + 2_000_000 + (k * 7919) % 10_000 * 1000; // 2 ms of delay, and 0 to 10 ms of jitter
///     let undelayed = clock.undelay(ticks, arrival).ok_or("a stray")?;
///     error = (undelayed.nanos - 2_000_000 - measured) as f64 * 1e-6;
/// }
/// assert!(error.abs() < 0.2, "{error} ms");
/// # Ok::<(), &str>(())
/// ```
#[derive(Debug, Clone)]
pub struct DeviceClock {
    envelope: Envelope,
    tick_nanos: f64,
    frame_nanos: Option<f64>,
    last: Option<(u32, i64)>,
    /// Time on the device's clock since the first record, in nanoseconds.
    device_nanos: f64,
    strays: u32,
    last_nanos: i64,
    jitter: (f64, f64),
}

impl DeviceClock {
    /// A clock whose ticks last so long by its data sheet, and its frames, when they are even.
    pub fn new(tick_nanos: f64, frame_nanos: Option<f64>) -> Self {
        Self {
            envelope: Envelope::new(WINDOW_NANOS),
            tick_nanos,
            // Frames shorter than a few ticks cannot be counted by them.
            frame_nanos: frame_nanos.filter(|frame| *frame > 2.0 * STEP_TICKS * tick_nanos),
            last: None,
            device_nanos: 0.0,
            strays: 0,
            last_nanos: i64::MIN,
            jitter: (0.0, 0.0),
        }
    }

    /// When a record with this time stamp would have arrived, had nothing delayed it; `None` for a time stamp that does
    /// not follow from those before it. Answers never fall behind the one before.
    pub fn undelay(&mut self, ticks: u32, arrival_nanos: i64) -> Option<Undelayed> {
        if let Some((last_ticks, last_arrival)) = self.last {
            let step_nanos = f64::from(ticks.wrapping_sub(last_ticks) as i32) * self.tick_nanos;
            let strays = (step_nanos - (arrival_nanos - last_arrival) as f64).abs() > STRAY_NANOS;
            if strays || step_nanos < 0.0 {
                self.strays += 1;
                if self.strays < STRAY_STREAK {
                    return None;
                }
                self.start_anew();
            } else {
                self.step(step_nanos);
            }
        }
        self.strays = 0;
        self.last = Some((ticks, arrival_nanos));
        self.envelope.push(self.device_nanos, arrival_nanos as f64);
        let settled = self.envelope.count() >= SETTLED_COUNT && self.envelope.duration() >= SETTLED_NANOS;
        let line = settled.then(|| self.envelope.fit(None)).flatten();
        let line = match line.filter(|line| (line.slope - 1.0).abs() < DRIFT_TOLERANCE) {
            Some(line) => line,
            None => self.envelope.fit(Some(1.0))?,
        };
        self.jitter = self.envelope.scatter(&line);
        // Over ticks, the envelope touches the arrivals that were measured at the very start of theirs.
        let middle = if self.frame_nanos.is_some() { 0.0 } else { 0.5 * self.tick_nanos };
        let nanos = (line.at(self.device_nanos) + middle) as i64;
        self.last_nanos = nanos.max(self.last_nanos);
        Some(Undelayed {
            nanos: self.last_nanos,
            removed_nanos: arrival_nanos - self.last_nanos,
            settled,
            held_up: false,
        })
    }

    /// The jitter that was taken away from the arrivals of the last seconds, the coarseness of ticks included: root mean
    /// square about its mean, and the most, in nanoseconds.
    pub fn jitter_nanos(&self) -> (f64, f64) {
        self.jitter
    }

    fn start_anew(&mut self) {
        self.envelope.clear();
        self.device_nanos = 0.0;
    }

    fn step(&mut self, step_nanos: f64) {
        let Some(frame) = self.frame_nanos else {
            self.device_nanos += step_nanos;
            return;
        };
        let whole = (step_nanos / frame).round() * frame;
        // Ticks do not gather up: each step is told to a tick, and over a long one the frame's own error shows as well.
        let tolerance = STEP_TICKS * self.tick_nanos + DRIFT_TOLERANCE * step_nanos;
        if whole > 0.0 && (whole - step_nanos).abs() <= tolerance {
            self.device_nanos += whole;
        } else {
            // Its frames are others than was thought, or not even.
            self.frame_nanos = None;
            self.start_anew();
        }
    }
}
