//! A device that is played: what it hears, and what it says when.

use crate::wire_nanos;
use std::collections::VecDeque;

/// A device that is played: bytes in, bytes out, each with its time on the host's clock.
pub trait Emulated: Send + 'static {
    /// The host has sent bytes.
    fn hear(&mut self, bytes: &[u8], now_nanos: i64);
    /// The next bytes that have left the device by now, and when the last of them did; `None` when there are no more.
    fn speak(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)>;
}

/// What a device has to say, at the pace of its line.
#[derive(Debug, Clone)]
pub struct Speech {
    baud: u32,
    saying: VecDeque<(i64, Vec<u8>)>,
    free_at_nanos: i64,
}

impl Speech {
    /// Nothing yet.
    pub fn new(baud: u32) -> Self {
        Self { baud, saying: VecDeque::new(), free_at_nanos: i64::MIN }
    }

    /// Says bytes from a moment on, behind what it is saying still.
    pub fn say(&mut self, from_nanos: i64, bytes: Vec<u8>) {
        self.free_at_nanos = self.free_at_nanos.max(from_nanos) + wire_nanos(bytes.len(), self.baud);
        self.saying.push_back((self.free_at_nanos, bytes));
    }

    /// When all has left that was said so far.
    pub fn free_at_nanos(&self) -> i64 {
        self.free_at_nanos
    }

    /// The next bytes that have left by now, and when the last of them did.
    pub fn leave(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)> {
        if self.saying.front().is_some_and(|(left, _)| *left <= now_nanos) { self.saying.pop_front() } else { None }
    }
}
