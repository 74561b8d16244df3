//! Records out of a stream of bytes, however broken.

use super::records::{Layout, MOST_BYTES, Record, begins, decode};
use serial_line::Tally;

/// Collects bytes into records. Where a record does not end as it should, the search goes on at its second byte; so no
/// whole record is lost to a broken one before it.
#[derive(Debug, Clone)]
pub struct Decoder {
    layout: Layout,
    length: usize,
    buffer: [u8; MOST_BYTES],
    have: usize,
    /// Bytes skipped since the last whole record.
    gap: usize,
    tally: Tally,
}

impl Decoder {
    /// For records of this layout.
    pub fn new(layout: Layout) -> Self {
        let length = layout.bytes().min(MOST_BYTES);
        Self { layout, length, buffer: [0; MOST_BYTES], have: 0, gap: 0, tally: Tally::default() }
    }

    /// Forgets a record that has begun: what follows has nothing to do with it. The counts go on.
    pub fn start_anew(&mut self) {
        self.tally.skipped_bytes += self.have as u64;
        (self.have, self.gap) = (0, 0);
    }

    /// Takes a byte; the record that it completes.
    pub fn push(&mut self, byte: u8) -> Option<Record> {
        self.buffer[self.have] = byte;
        self.have += 1;
        let header = self.layout.family.header_bytes();
        if self.have <= header && !begins(&self.buffer[..self.have], &self.layout) {
            self.search();
        }
        if self.have < self.length {
            return None;
        }
        let Some(record) = decode(&self.buffer[..self.length], &self.layout) else {
            self.search();
            return None;
        };
        // Pieces of at least half a record were one.
        let pieces = (self.gap + self.length / 2) / self.length;
        self.tally.lose(u32::try_from(pieces).unwrap_or(u32::MAX));
        (self.have, self.gap) = (0, 0);
        self.tally.records += 1;
        Some(record)
    }

    /// Drops the first byte, and all others up to one that may begin a record.
    fn search(&mut self) {
        let header = self.layout.family.header_bytes();
        let fits = |start: &usize| begins(&self.buffer[*start..self.have.min(*start + header)], &self.layout);
        let start = (1..self.have).find(fits).unwrap_or(self.have);
        self.buffer.copy_within(start..self.have, 0);
        self.have -= start;
        self.tally.skipped_bytes += start as u64;
        if self.tally.records > 0 {
            self.gap += start;
        }
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
