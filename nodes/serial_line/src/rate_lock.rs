//! When records of a device without a clock would have arrived, had nothing delayed them.

use crate::{Envelope, Undelayed};

/// Crystals hold their rate for much longer; a rate that was set anew is followed as fast.
const WINDOW_NANOS: f64 = 8e9;
/// Before so much has been heard, the device's own word for its rate is better than the hull's.
const SETTLED_NANOS: f64 = 1e9;
const SETTLED_COUNT: usize = 32;
/// How far a device's own word for its rate may be off.
const RATE_TOLERANCE: f64 = 0.05;
/// After a longer silence nobody knows how many cycles have passed.
const SILENCE_PERIODS: f64 = 50.0;
/// So many records in a row, and for so long, that are late by most of a period: one was lost unseen. The time tells that
/// from a host that stood still, and then read what had come meanwhile all at once.
const LATE_STREAK: u32 = 16;
const LATE_NANOS: f64 = 2.5e8;
const LATE_PERIODS: f64 = 0.6;
/// Who comes so soon behind another was held up with it.
const HASTY_PERIODS: f64 = 0.3;
/// A settled lock is better than this; who is earlier was counted wrongly.
const EARLY_PERIODS: f64 = 0.15;

/// Records that were counted in as lost, from this index on.
#[derive(Debug, Clone, Copy)]
struct Suspect {
    from: i64,
    count: i64,
}

/// Records in a row that are late.
#[derive(Debug, Clone, Copy)]
struct Late {
    since: f64,
    records: u32,
    least_periods: f64,
}

/// A device that measures at an even rate: record k was measured at t0 + k T, and arrives late, never early. The lock
/// counts k, and finds t0 and T as the line under all arrivals ([`Envelope`]).
///
/// Records that were lost are counted in from what the decoder saw of them; those that it never saw show by all that
/// follows being late by a whole period, and one counted too many by a record that would be here before it was sent.
///
/// ```
/// let mut lock = serial_line::RateLock::new(Some(10_000_000.0));
/// let mut last = 0.0;
/// for k in 0..1000_i64 {
///     let late = (k * 7919) % 10_000 * 1000; // 0 to 10 ms
///     let arrival = lock.undelay(k * 10_000_000 + late, 0);
///     last = (arrival.nanos - k * 10_000_000) as f64 * 1e-6;
/// }
/// assert!(last.abs() < 0.3, "{last} ms");
/// assert!(lock.jitter_nanos().0 > 2e6, "and says what it took away");
/// ```
#[derive(Debug, Clone)]
pub struct RateLock {
    envelope: Envelope,
    said_period: Option<f64>,
    period: Option<f64>,
    index: i64,
    last_arrival: Option<i64>,
    last_nanos: i64,
    late: Option<Late>,
    suspect: Option<Suspect>,
    jitter: (f64, f64),
}

impl RateLock {
    /// A lock, with the period in nanoseconds as the device says it, when it does.
    pub fn new(said_period: Option<f64>) -> Self {
        let said_period = said_period.filter(|period| period.is_finite() && *period > 0.0);
        Self {
            envelope: Envelope::new(WINDOW_NANOS),
            said_period,
            period: said_period,
            index: 0,
            last_arrival: None,
            last_nanos: i64::MIN,
            late: None,
            suspect: None,
            jitter: (0.0, 0.0),
        }
    }

    /// Takes the arrival of a record, before which the decoder saw `missed` others go by in pieces. Answers are in
    /// strictly rising order.
    pub fn undelay(&mut self, arrival_nanos: i64, missed: u32) -> Undelayed {
        let silence = self.last_arrival.map(|last| arrival_nanos.saturating_sub(last));
        let most = self.period.map_or(1e9, |period| period * SILENCE_PERIODS);
        let anew = silence.is_none_or(|silence| silence as f64 > most || silence < 0);
        if anew {
            self.start_anew();
        }
        let hasty = silence.zip(self.period).is_some_and(|(silence, period)| (silence as f64) < HASTY_PERIODS * period);
        self.last_arrival = Some(arrival_nanos);
        self.count(arrival_nanos as f64, missed);
        self.envelope.push(self.index as f64, arrival_nanos as f64);
        let settled = self.envelope.count() >= SETTLED_COUNT && self.envelope.duration() >= SETTLED_NANOS;
        let nanos = self.refit(settled).unwrap_or(arrival_nanos as f64) as i64;
        self.last_nanos = nanos.min(arrival_nanos).max(self.last_nanos.saturating_add(1));
        let removed_nanos = arrival_nanos - self.last_nanos;
        // A host that stood still for long reads all at once what came meanwhile.
        Undelayed { nanos: self.last_nanos, removed_nanos, settled, held_up: !settled && (anew || hasty) }
    }

    /// The period, in nanoseconds; `None` before two records.
    pub fn period_nanos(&self) -> Option<f64> {
        self.period
    }

    /// The jitter that was taken away from the arrivals of the last seconds: root mean square about its mean, and the
    /// most, in nanoseconds.
    pub fn jitter_nanos(&self) -> (f64, f64) {
        self.jitter
    }

    fn start_anew(&mut self) {
        self.envelope.clear();
        self.index = 0;
        self.late = None;
        self.suspect = None;
    }

    fn count(&mut self, arrival: f64, missed: u32) {
        // A decoder in a storm of errors says large numbers; a silence of that length would have started the count anew.
        let missed = i64::from(missed.min(SILENCE_PERIODS as u32));
        self.index += 1 + missed;
        if missed > 0 {
            self.suspect = Some(Suspect { from: self.index, count: missed });
        }
        let Some(period) = self.period else { return };
        let Some(line) = self.envelope.fit(Some(period)) else { return };
        let late = (arrival - line.at(self.index as f64)) / period;
        if late < -EARLY_PERIODS {
            self.take_back(late);
        } else if late > LATE_PERIODS {
            let before = self.late.unwrap_or(Late { since: arrival, records: 0, least_periods: f64::INFINITY });
            let streak = Late { records: before.records + 1, least_periods: before.least_periods.min(late), ..before };
            if streak.records < LATE_STREAK || arrival - streak.since < LATE_NANOS {
                self.late = Some(streak);
                return;
            }
            let unseen = streak.least_periods.round() as i64;
            self.index += unseen;
            self.suspect = Some(Suspect { from: self.index, count: unseen });
        }
        self.late = None;
    }

    /// Here before it was sent: fewer were lost than it seemed.
    fn take_back(&mut self, late: f64) {
        let Some(Suspect { from, count }) = self.suspect.take() else { return };
        let too_many = (-late.round() as i64).clamp(1, count);
        self.envelope.shift_from(from as f64, -too_many as f64);
        self.index -= too_many;
        self.suspect = (count > too_many).then_some(Suspect { from: from - too_many, count: count - too_many });
    }

    /// The line under the arrivals, at the newest of them.
    fn refit(&mut self, settled: bool) -> Option<f64> {
        let hull = settled.then(|| self.envelope.fit(None)).flatten();
        let plausible =
            |slope: f64| slope > 0.0 && self.said_period.is_none_or(|said| (slope / said - 1.0).abs() < RATE_TOLERANCE);
        let line = match hull.filter(|line| plausible(line.slope)) {
            Some(line) => line,
            None => {
                let slope = self.said_period.or_else(|| self.envelope.mean_slope())?;
                self.envelope.fit(Some(slope))?
            }
        };
        self.period = Some(line.slope);
        self.jitter = self.envelope.scatter(&line);
        Some(line.at(self.index as f64))
    }
}
