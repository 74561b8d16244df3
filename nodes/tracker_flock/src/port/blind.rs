//! Sensors that measure nothing while they stream.

use std::time::{Duration, Instant};

/// Asking costs the other sensors some records, so it is not done again before so long.
const ASKED_AGAIN: Duration = Duration::from_secs(30);

/// Counts the records in a row in which a unit has measured nothing.
#[derive(Debug, Clone, Default)]
pub(super) struct Blind {
    units: Vec<(u8, u32)>,
    asked: Option<Instant>,
}

impl Blind {
    /// For these units.
    pub fn new(addresses: &[u8]) -> Self {
        Self { units: addresses.iter().map(|&address| (address, 0)).collect(), asked: None }
    }

    /// A record of a unit has come.
    pub fn note(&mut self, address: u8, measured: bool) {
        if let Some((_, nothing)) = self.units.iter_mut().find(|(unit, _)| *unit == address) {
            *nothing = if measured { 0 } else { *nothing + 1 };
        }
    }

    /// The unit to ask why: it has measured nothing in so many records, and nobody was asked lately.
    pub fn whom(&mut self, records: u32) -> Option<u8> {
        if self.asked.is_some_and(|at| at.elapsed() < ASKED_AGAIN) {
            return None;
        }
        let (address, nothing) = self.units.iter_mut().find(|(_, nothing)| *nothing >= records)?;
        *nothing = 0;
        self.asked = Some(Instant::now());
        Some(*address)
    }
}
