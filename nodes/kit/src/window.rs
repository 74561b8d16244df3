//! How far a source at a fast pace may run ahead of the nodes behind it.

use crate::ports::Input;
use bus::Presence;
use std::collections::{BTreeMap, VecDeque};
use std::time::{Duration, Instant};
use wire::Progress;

/// No node holds back for longer what it has heard: one that smooths needs to know what comes after.
const HELD_BACK_NANOS: i64 = 500_000_000;
/// When nobody has moved for so long, one message is let through: a scan may be slow, but it must not stop.
const STANDSTILL: Duration = Duration::from_secs(10);

/// How far each consumer has come.
pub(crate) struct Window {
    progress: Input<Progress>,
    presence: Presence,
    /// How often a node had become ready when it was last looked at.
    arrivals: u64,
    reached: BTreeMap<String, i64>,
    scan: u64,
    window_nanos: i64,
    /// The stamps that were admitted last: the newest one that nobody holds back any more, and those behind it.
    admitted: VecDeque<i64>,
    moved: Instant,
}

/// What a source may do with its next message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Turn {
    Now,
    Wait,
    /// Nobody has moved for long: now, but it should be said.
    Anyway,
}

impl Window {
    pub(crate) fn new(progress: Input<Progress>, presence: Presence, consumers: &[String], window_ms: u64) -> Self {
        let reached = consumers.iter().map(|node| (node.clone(), 0)).collect();
        let window_nanos = i64::try_from(window_ms).unwrap_or(i64::MAX).saturating_mul(1_000_000);
        let (admitted, moved) = (VecDeque::new(), Instant::now());
        Self { progress, presence, arrivals: 0, reached, scan: 0, window_nanos, admitted, moved }
    }

    /// A new scan starts at 0 for everyone.
    pub(crate) fn start_scan(&mut self, scan: u64) {
        self.scan = scan;
        self.admitted.clear();
        self.moved = Instant::now();
        self.reached.values_mut().for_each(|stamp| *stamp = 0);
    }

    /// May a message with this stamp be sent? It may when it lies within the window, or when everybody has done all that
    /// cannot be held back any more.
    pub(crate) fn turn(&mut self, stamp_nanos: i64) -> Turn {
        while let Some(progress) = self.progress.next() {
            if let Some(stamp) = self.reached.get_mut(&progress.node)
                && progress.header.scan == self.scan
                && progress.header.stamp_nanos > *stamp
            {
                *stamp = progress.header.stamp_nanos;
                self.moved = Instant::now();
            }
        }
        let newest = self.admitted.back().copied().unwrap_or(i64::MIN);
        // A node has come back: what was on its way to it when it died will never be reported as done, by nobody.
        let arrivals = self.presence.arrivals();
        if std::mem::replace(&mut self.arrivals, arrivals) != arrivals {
            self.reached.values_mut().for_each(|stamp| *stamp = (*stamp).max(newest));
        }
        let due = self.admitted.front().copied().filter(|first| *first <= newest.saturating_sub(HELD_BACK_NANOS));
        let due = due.unwrap_or(i64::MIN);
        let may = |reached: &i64| stamp_nanos <= reached.saturating_add(self.window_nanos) || due <= *reached;
        let turn = if self.reached.values().all(may) {
            Turn::Now
        } else if self.moved.elapsed() >= STANDSTILL {
            Turn::Anyway
        } else {
            return Turn::Wait;
        };
        self.admit(stamp_nanos);
        turn
    }

    fn admit(&mut self, stamp_nanos: i64) {
        self.moved = Instant::now();
        self.admitted.push_back(stamp_nanos);
        while self.admitted.get(1).is_some_and(|next| *next <= stamp_nanos.saturating_sub(HELD_BACK_NANOS)) {
            self.admitted.pop_front();
        }
    }

    /// Who is furthest behind.
    pub(crate) fn slowest(&self) -> &str {
        self.reached.iter().min_by_key(|(_, stamp)| **stamp).map_or("nobody", |(node, _)| node)
    }
}
