//! What a decoder has seen.

/// Since it was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tally {
    /// Whole records.
    pub records: u64,
    /// Records that began and did not end as they should.
    pub broken: u64,
    /// Bytes that belong to no whole record.
    pub skipped_bytes: u64,
    missed: u32,
}

impl Tally {
    /// So many records have come in pieces.
    pub fn lose(&mut self, records: u32) {
        self.broken += u64::from(records);
        self.missed = self.missed.saturating_add(records);
    }

    /// How many have come in pieces since this was asked last.
    pub fn take_missed(&mut self) -> u32 {
        std::mem::take(&mut self.missed)
    }
}
