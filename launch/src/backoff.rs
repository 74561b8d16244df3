//! When a node that failed is started again.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Failures further back than this are forgiven.
pub const WINDOW: Duration = Duration::from_secs(60);
/// With so many failures within the window, a node has failed for good.
pub const MOST: usize = 5;
const FIRST_PAUSE: Duration = Duration::from_millis(250);
const LONGEST_PAUSE: Duration = Duration::from_secs(4);

/// Remembers the failures of one node.
///
/// ```
/// use std::time::{Duration, Instant};
/// let mut backoff = limn::backoff::Backoff::default();
/// let start = Instant::now();
/// assert_eq!(backoff.failed(start), Some(Duration::from_millis(250)));
/// assert_eq!(backoff.failed(start), Some(Duration::from_millis(500)));
/// ```
#[derive(Debug, Default)]
pub struct Backoff {
    failures: VecDeque<Instant>,
}

impl Backoff {
    /// Notes a failure; returns how long to wait before the next start, or `None` when there shall be none.
    pub fn failed(&mut self, now: Instant) -> Option<Duration> {
        while self.failures.front().is_some_and(|&at| now.duration_since(at) > WINDOW) {
            self.failures.pop_front();
        }
        let doublings = self.failures.len();
        self.failures.push_back(now);
        (doublings < MOST).then(|| LONGEST_PAUSE.min(FIRST_PAUSE * (1 << doublings)))
    }
}
