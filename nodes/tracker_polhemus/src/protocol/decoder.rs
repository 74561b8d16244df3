//! Records out of a stream of bytes, however broken.

use super::records::{Layout, MOST_BYTES, Record, begins, decode};

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
    missed: u32,
    records: u64,
    broken: u64,
    skipped_bytes: u64,
}

impl Decoder {
    /// For records of this layout.
    pub fn new(layout: Layout) -> Self {
        let length = layout.bytes().min(MOST_BYTES);
        Self {
            layout,
            length,
            buffer: [0; MOST_BYTES],
            have: 0,
            gap: 0,
            missed: 0,
            records: 0,
            broken: 0,
            skipped_bytes: 0,
        }
    }

    /// Forgets a record that has begun: what follows has nothing to do with it. The counts go on.
    pub fn start_anew(&mut self) {
        self.skipped_bytes += self.have as u64;
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
        self.missed = self.missed.saturating_add(pieces as u32);
        self.broken += pieces as u64;
        (self.have, self.gap) = (0, 0);
        self.records += 1;
        Some(record)
    }

    /// Drops the first byte, and all others up to one that may begin a record.
    fn search(&mut self) {
        let header = self.layout.family.header_bytes();
        let fits = |start: &usize| begins(&self.buffer[*start..self.have.min(*start + header)], &self.layout);
        let start = (1..self.have).find(fits).unwrap_or(self.have);
        self.buffer.copy_within(start..self.have, 0);
        self.have -= start;
        self.skipped_bytes += start as u64;
        if self.records > 0 {
            self.gap += start;
        }
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
