//! What a session needs of a device, and what it tells of it.

use crate::{Line, LineError, Tally};
use std::time::Duration;

/// Why nothing is measured.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Trouble {
    /// The port.
    #[error(transparent)]
    Line(#[from] LineError),
    /// What is at its other end; a sentence with what to do.
    #[error("{0}")]
    Device(String),
    /// It has not answered, and may be starting up: [`Device::set_up`] is called once more on the same line, and waits for
    /// it there. What is to be said till then.
    #[error("{0}")]
    Starting(String),
}

/// A device at the other end of a line.
pub trait Device: Send + 'static {
    /// What it sends.
    type Record: Send + 'static;
    /// Brings it from any state to sending records; what it found, in a sentence.
    fn set_up(&mut self, line: &mut Line) -> Result<String, Trouble>;
    /// Takes bytes; calls back for each whole record.
    fn take(&mut self, bytes: &[u8], each: &mut dyn FnMut(Heard<Self::Record>));
    /// Looks whether it should be asked something while it streams, and asks: what is wrong, in a sentence.
    ///
    /// # Errors
    /// Nothing is measured any more.
    fn ask_why(&mut self, _: &mut Line) -> Result<Option<String>, Trouble> {
        Ok(None)
    }
    /// What it has seen so far.
    fn tally(&self) -> Tally;
    /// How long it may be quiet.
    fn most_silence(&self) -> Duration;
    /// What to say when nothing comes.
    fn silence(&self) -> String;
    /// What to say when bytes come that are no records; a sample of them.
    fn garbage(&self, sample: &[u8]) -> String;
}

/// A record within the bytes that a device was given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Heard<R> {
    /// What was read.
    pub record: R,
    /// How many of the bytes lie behind it.
    pub behind: usize,
    /// Records since the one before that came in pieces.
    pub missed: u32,
}

/// A record, and when its last byte came, on the host's clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arrived<R> {
    /// The arrival.
    pub nanos: i64,
    /// What came.
    pub record: R,
    /// Records since the one before that came in pieces.
    pub missed: u32,
}

/// What the operator should know.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum News {
    /// It works (again); what was found.
    Streaming(String),
    /// It does not, or not yet; it is tried again.
    Trouble(Trouble),
    /// It works, but not well: the line, or a sensor.
    Noisy(String),
}

/// The account of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Whole records.
    pub records: u64,
    /// Records that began and did not end as they should.
    pub broken: u64,
    /// Bytes that belong to no whole record.
    pub skipped_bytes: u64,
    /// How often it was set up.
    pub starts: u64,
    /// Records that nobody fetched in time.
    pub overflowed: u64,
}
