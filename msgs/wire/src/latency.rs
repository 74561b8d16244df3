//! How old results were, all of them: a histogram that travels in a node's account.

use crate::layout::layout;

/// Bins to each doubling: none is wider than a thirty-second of what it counts.
const PER_OCTAVE: u64 = 32;
/// Below so many microseconds a bin is one microsecond wide.
const LINEAR: u64 = PER_OCTAVE;
/// Two minutes: what is older is counted with it.
const LONGEST: u64 = 1 << 27;

layout! {
    /// Latencies (now - stamp), counted in bins that widen with them: 1 microsecond up to 32, then 32 bins to each
    /// doubling, up to two minutes.
    #[derive(Default, Eq)]
    pub struct Latencies {
        /// How many fell into each bin; bins behind the last are empty.
        pub bins: Vec<u32>,
    }
}

/// The bin of so many microseconds.
fn bin(micros: u64) -> usize {
    let micros = micros.min(LONGEST - 1);
    if micros < LINEAR {
        return micros as usize;
    }
    let octave = u64::from(micros.ilog2() - LINEAR.ilog2());
    (octave * PER_OCTAVE + (micros >> octave)) as usize
}

/// Where a bin begins and how wide it is, in microseconds. A bin that no latency falls into, as hostile bytes may tell of,
/// begins where the last one does.
fn extent(bin: usize) -> [f64; 2] {
    let bin = (bin as u64).min(self::bin(LONGEST) as u64);
    let octave = (bin / PER_OCTAVE).saturating_sub(1);
    let width = 1u64 << octave;
    [((bin - octave * PER_OCTAVE) * width) as f64, width as f64]
}

impl Latencies {
    /// Counts one, in nanoseconds; one below zero (clocks that differ) as zero.
    pub fn note(&mut self, nanos: i64) {
        let bin = bin(u64::try_from(nanos / 1000).unwrap_or(0));
        if self.bins.len() <= bin {
            self.bins.resize(bin + 1, 0);
        }
        self.bins[bin] = self.bins[bin].saturating_add(1);
    }

    /// Counts all that another has counted.
    pub fn add(&mut self, other: &Self) {
        if self.bins.len() < other.bins.len() {
            self.bins.resize(other.bins.len(), 0);
        }
        self.bins.iter_mut().zip(&other.bins).for_each(|(here, there)| *here = here.saturating_add(*there));
    }

    /// How many were counted.
    pub fn count(&self) -> u64 {
        self.bins.iter().map(|count| u64::from(*count)).sum()
    }

    /// The latency in nanoseconds that a share (0 to 1) of all does not exceed, by nearest rank (the median of five is the third,
    /// their 99th percentile the fifth), right to within its bin; `None` when nothing was counted.
    ///
    /// ```
    /// let mut latencies = wire::Latencies::default();
    /// (1..=1000).for_each(|millis| latencies.note(millis * 1_000_000));
    /// let [median, slowest] = [0.5, 0.99].map(|share| latencies.percentile(share).unwrap() as f64);
    /// assert!((median / 500e6 - 1.0).abs() < 0.03 && (slowest / 990e6 - 1.0).abs() < 0.03);
    /// ```
    pub fn percentile(&self, share: f64) -> Option<i64> {
        let rank = ((self.count() as f64 * share).ceil() as u64).clamp(1, self.count().max(1));
        let mut before = 0;
        for (bin, count) in self.bins.iter().map(|count| u64::from(*count)).enumerate() {
            if before + count >= rank {
                let [from, width] = extent(bin);
                // In the middle of its share of the bin.
                let inside = ((rank - before) as f64 - 0.5) / count as f64;
                return Some(((from + width * inside) * 1000.0) as i64);
            }
            before += count;
        }
        None
    }
}
