//! Records out of a stream of bytes, however broken.

use super::records::{Layout, MOST_BYTES, PHASE, Record, decode};

/// Collects bytes into records. A byte with the phase bit begins a record wherever it comes; so a record that was not
/// touched is found whatever came before it.
#[derive(Debug, Clone)]
pub struct Decoder {
    layout: Layout,
    length: usize,
    buffer: [u8; MOST_BYTES],
    have: usize,
    skipping: bool,
    missed: u32,
    records: u64,
    broken: u64,
    skipped_bytes: u64,
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
            missed: 0,
            records: 0,
            broken: 0,
            skipped_bytes: 0,
        }
    }

    /// What it looks for.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Looks for another layout from here on; the counts go on.
    pub fn expect(&mut self, layout: Layout) {
        *self = Self {
            records: self.records,
            broken: self.broken,
            skipped_bytes: self.skipped_bytes + self.have as u64,
            ..Self::new(layout)
        };
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
            self.skipped_bytes += 1;
            if !self.skipping && self.records > 0 {
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
        self.records += 1;
        Some(decode(&self.buffer[..self.length], &self.layout))
    }

    fn lose(&mut self, bytes: usize) {
        self.broken += 1;
        self.missed = self.missed.saturating_add(1);
        self.skipped_bytes += bytes as u64;
    }

    /// How many records have come in pieces since this was asked last.
    pub fn take_missed(&mut self) -> u32 {
        std::mem::take(&mut self.missed)
    }

    /// Whole records so far.
    pub fn records(&self) -> u64 {
        self.records
    }

    /// Records so far that came in pieces.
    pub fn broken(&self) -> u64 {
        self.broken
    }

    /// Bytes so far that belong to no whole record.
    pub fn skipped_bytes(&self) -> u64 {
        self.skipped_bytes
    }
}
