//! Records out of a stream of bytes, however broken.

use super::records::{Layout, MOST_BYTES, PHASE, Record, decode};
use serial_line::Tally;

/// Collects bytes into records. A byte with the phase bit begins a record wherever it comes; so a record that was not
/// touched is found whatever came before it.
#[derive(Debug, Clone)]
pub struct Decoder {
    layout: Layout,
    length: usize,
    buffer: [u8; MOST_BYTES],
    have: usize,
    skipping: bool,
    tally: Tally,
}

impl Decoder {
    /// For records of this layout.
    pub fn new(layout: Layout) -> Self {
        Self {
            layout,
            length: layout.bytes(),
            buffer: [0; MOST_BYTES],
            have: 0,
            skipping: false,
            tally: Tally::default(),
        }
    }

    /// What it looks for.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Looks for another layout from here on; the counts go on.
    pub fn expect(&mut self, layout: Layout) {
        self.tally.skipped_bytes += self.have as u64;
        self.tally.take_missed();
        *self = Self { tally: self.tally, ..Self::new(layout) };
    }

    /// Takes a byte; the record that it completes.
    pub fn push(&mut self, byte: u8) -> Option<Record> {
        if byte & PHASE != 0 {
            if self.have > 0 {
                self.lose(self.have);
            }
            self.have = 0;
            self.skipping = false;
        } else if self.have == 0 {
            // A record whose beginning is lost, or noise.
            self.tally.skipped_bytes += 1;
            if !self.skipping && self.tally.records > 0 {
                self.skipping = true;
                self.lose(0);
            }
            return None;
        }
        self.buffer[self.have] = byte;
        self.have += 1;
        if self.have < self.length {
            return None;
        }
        self.have = 0;
        self.tally.records += 1;
        Some(decode(&self.buffer[..self.length], &self.layout))
    }

    fn lose(&mut self, bytes: usize) {
        self.tally.lose(1);
        self.tally.skipped_bytes += bytes as u64;
    }

    /// How many records have come in pieces since this was asked last.
    pub fn take_missed(&mut self) -> u32 {
        self.tally.take_missed()
    }

    /// What it has seen so far.
    pub fn tally(&self) -> Tally {
        self.tally
    }
}
