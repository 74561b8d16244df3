//! A line that is half dead.

use std::time::{Duration, Instant};

/// A line on which more of the bytes than this belong to no record is half dead.
const NOISY_SHARE: f64 = 0.25;
const WINDOW: Duration = Duration::from_secs(1);
const NAMED_AGAIN: Duration = Duration::from_secs(30);

/// Bytes that came, and those of them that belong to no record.
pub(crate) struct Noise {
    since: Instant,
    bytes: u64,
    skipped: u64,
    named: Option<Instant>,
}

impl Noise {
    /// From here on, when so many were skipped before.
    pub fn new(skipped: u64) -> Self {
        Self { since: Instant::now(), bytes: 0, skipped, named: None }
    }

    /// Bytes have come.
    pub fn hear(&mut self, bytes: usize) {
        self.bytes += bytes as u64;
    }

    /// The share of bytes that were skipped in the last second, when it is high and was not told lately; from how many
    /// were skipped in all.
    pub fn share(&mut self, skipped: u64) -> Option<f64> {
        if self.since.elapsed() < WINDOW {
            return None;
        }
        let share = skipped.saturating_sub(self.skipped) as f64 / self.bytes.max(1) as f64;
        (self.since, self.bytes, self.skipped) = (Instant::now(), 0, skipped);
        let lately = self.named.is_some_and(|at| at.elapsed() < NAMED_AGAIN);
        if share < NOISY_SHARE || lately {
            return None;
        }
        self.named = Some(Instant::now());
        Some(share.min(1.0))
    }
}
