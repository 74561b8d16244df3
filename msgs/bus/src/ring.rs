//! Received messages on their way to a node's loop.
//!
//! Zenoh's own queues block its receiving thread when they are full, and with it every topic of the session. A ring
//! drops its oldest instead; the gap shows in the sequence numbers and is counted as a loss.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};
use zenoh::sample::Sample;

/// Tells a node's loop that something has come, on whichever topic.
#[derive(Debug, Default)]
pub(crate) struct Bell {
    rung: Mutex<bool>,
    condition: Condvar,
}

impl Bell {
    pub(crate) fn ring(&self) {
        *self.rung.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.condition.notify_all();
    }

    /// Waits until it has rung since the last wait; false when the time ran out.
    pub(crate) fn wait(&self, timeout: Duration) -> bool {
        let deadline = Instant::now() + timeout;
        let mut rung = self.rung.lock().unwrap_or_else(PoisonError::into_inner);
        while !*rung {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return false;
            }
            rung = self.condition.wait_timeout(rung, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        *rung = false;
        true
    }
}

/// The newest samples of one subscription.
#[derive(Debug, Clone)]
pub(crate) struct Ring {
    samples: Arc<Mutex<VecDeque<Sample>>>,
    depth: usize,
    bell: Arc<Bell>,
}

impl Ring {
    pub(crate) fn new(depth: usize, bell: Arc<Bell>) -> Self {
        Self { samples: Arc::default(), depth: depth.max(1), bell }
    }

    pub(crate) fn depth(&self) -> usize {
        self.depth
    }

    pub(crate) fn push(&self, sample: Sample) {
        let mut samples = self.samples.lock().unwrap_or_else(PoisonError::into_inner);
        if samples.len() == self.depth {
            samples.pop_front();
        }
        samples.push_back(sample);
        drop(samples);
        self.bell.ring();
    }

    pub(crate) fn pop(&self) -> Option<Sample> {
        self.samples.lock().unwrap_or_else(PoisonError::into_inner).pop_front()
    }
}
