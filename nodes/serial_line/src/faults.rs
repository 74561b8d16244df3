//! What goes wrong on real lines, for emulators.

/// Which faults, how many. Nothing by default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FaultsConfig {
    /// The same seed gives the same faults.
    pub seed: u64,
    /// Bytes arrive late by 0 to so many nanoseconds, evenly; never out of order.
    pub jitter_nanos: i64,
    /// So many of a million bytes have a bit turned over.
    pub flipped_ppm: u32,
    /// So many of a million bytes do not arrive.
    pub lost_ppm: u32,
    /// Before so many of a million deliveries come up to 64 bytes of anything.
    pub garbage_ppm: u32,
    /// The line is cut every so many nanoseconds of the sender's clock, the first time after so many; 0 is never.
    pub cut_every_nanos: i64,
    /// For so long nothing passes then, either way.
    pub cut_for_nanos: i64,
}

impl FaultsConfig {
    /// Whether the line is cut at a moment of the sender's clock.
    pub fn is_cut(&self, nanos: i64) -> bool {
        let every = self.cut_every_nanos;
        every > 0 && nanos >= every && nanos % every < self.cut_for_nanos
    }
}

/// Bytes, and when they arrive.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Delivery {
    /// On the clock of the sender.
    pub due_nanos: i64,
    /// What arrives.
    pub bytes: Vec<u8>,
}

/// A line with faults.
#[derive(Debug, Clone)]
pub struct Faults {
    config: FaultsConfig,
    state: u64,
    last_due: i64,
}

const MILLION: u64 = 1_000_000;

impl Faults {
    /// A line with these faults.
    pub fn new(config: FaultsConfig) -> Self {
        Self { config, state: config.seed, last_due: i64::MIN }
    }

    /// Whether the line is cut at a moment of the sender's clock.
    pub fn is_cut(&self, nanos: i64) -> bool {
        self.config.is_cut(nanos)
    }

    /// What becomes of bytes that were sent at a moment.
    pub fn deliver(&mut self, sent_nanos: i64, bytes: &[u8]) -> Delivery {
        if self.is_cut(sent_nanos) {
            return Delivery { due_nanos: self.last_due.max(sent_nanos), bytes: Vec::new() };
        }
        let mut arriving = Vec::with_capacity(bytes.len());
        if self.happens(self.config.garbage_ppm) {
            let count = self.below(64) + 1;
            arriving.extend((0..count).map(|_| self.next() as u8));
        }
        for &byte in bytes {
            if self.happens(self.config.lost_ppm) {
                continue;
            }
            let turned = if self.happens(self.config.flipped_ppm) { 1 << self.below(8) } else { 0 };
            arriving.push(byte ^ turned);
        }
        let late =
            if self.config.jitter_nanos > 0 { self.below(self.config.jitter_nanos as u64 + 1) as i64 } else { 0 };
        self.last_due = self.last_due.max(sent_nanos.saturating_add(late));
        Delivery { due_nanos: self.last_due, bytes: arriving }
    }

    fn happens(&mut self, ppm: u32) -> bool {
        ppm > 0 && self.below(MILLION) < u64::from(ppm)
    }

    fn below(&mut self, bound: u64) -> u64 {
        ((u128::from(self.next()) * u128::from(bound)) >> 64) as u64
    }

    /// SplitMix64 (Steele, Lea, Flood 2014).
    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}
