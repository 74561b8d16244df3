//! Records that wait to be fetched.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// More than ten seconds of any tracker.
const WAITING: usize = 4096;

/// Holds the newest; who is not fetched in time makes room.
pub(crate) struct Ring<T> {
    waiting: Mutex<VecDeque<T>>,
    filled: Condvar,
}

impl<T> Ring<T> {
    pub fn new() -> Self {
        Self { waiting: Mutex::new(VecDeque::with_capacity(WAITING)), filled: Condvar::new() }
    }

    /// Puts one in; whether another had to make room.
    pub fn push(&self, item: T) -> bool {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let full = waiting.len() == WAITING;
        if full {
            waiting.pop_front();
        }
        waiting.push_back(item);
        self.filled.notify_one();
        full
    }

    /// The oldest; waits so long for one.
    pub fn pop(&self, wait: Duration) -> Option<T> {
        let waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let (mut waiting, _) = self
            .filled
            .wait_timeout_while(waiting, wait, |waiting| waiting.is_empty())
            .unwrap_or_else(PoisonError::into_inner);
        waiting.pop_front()
    }
}
