//! When a source may send: in real time, or as fast as the slowest of its consumers.

use crate::ports::Input;
use bus::Presence;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use wire::{Phase, Progress};

/// How simulated and replayed sources keep time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pace {
    /// As it would be with real devices; who cannot follow loses messages, and they are counted.
    #[default]
    Real,
    /// As fast as the machine can, with nothing lost.
    Fast,
}

/// The operator has said go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Go {
    /// Which scan.
    pub scan: u64,
    /// In which phase.
    pub phase: Phase,
    /// The system clock when the scan's own clock stood at 0.
    pub epoch_nanos: i64,
}

/// Now, on the system clock.
pub(crate) fn system_nanos() -> i64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_nanos() as i64)
}

/// How long a source at real pace still has to wait for a stamp; `None` when its time has come.
pub(crate) fn until(epoch_nanos: i64, stamp_nanos: i64) -> Option<Duration> {
    let left = epoch_nanos + stamp_nanos - system_nanos();
    (left > 0).then(|| Duration::from_nanos(left as u64))
}

/// How far each consumer has come.
pub(crate) struct Window {
    progress: Input<Progress>,
    presence: Presence,
    /// How often a node had become ready when it was last looked at.
    arrivals: u64,
    reached: BTreeMap<String, i64>,
    scan: u64,
    window_nanos: i64,
    /// The stamp that was admitted last.
    admitted: Option<i64>,
}

impl Window {
    pub(crate) fn new(progress: Input<Progress>, presence: Presence, consumers: &[String], window_ms: u64) -> Self {
        let reached = consumers.iter().map(|node| (node.clone(), 0)).collect();
        let window_nanos = window_ms as i64 * 1_000_000;
        Self { progress, presence, arrivals: 0, reached, scan: 0, window_nanos, admitted: None }
    }

    /// A new scan starts at 0 for everyone.
    pub(crate) fn start_scan(&mut self, scan: u64) {
        self.scan = scan;
        self.admitted = None;
        self.reached.values_mut().for_each(|stamp| *stamp = 0);
    }

    /// True when a message with this stamp may be sent: it lies within the window, or everybody has done all there was.
    pub(crate) fn admits(&mut self, stamp_nanos: i64) -> bool {
        while let Some(progress) = self.progress.next() {
            if let Some(stamp) = self.reached.get_mut(&progress.node)
                && progress.header.scan == self.scan
            {
                *stamp = (*stamp).max(progress.header.stamp_nanos);
            }
        }
        let admitted = self.admitted.unwrap_or(i64::MIN);
        // A node has come back: what was on its way to it when it died will never be reported as done, by nobody.
        let arrivals = self.presence.arrivals();
        if std::mem::replace(&mut self.arrivals, arrivals) != arrivals {
            self.reached.values_mut().for_each(|stamp| *stamp = (*stamp).max(admitted));
        }
        let may = |reached: &i64| stamp_nanos <= reached + self.window_nanos || admitted <= *reached;
        let admits = self.reached.values().all(may);
        if admits {
            self.admitted = Some(stamp_nanos);
        }
        admits
    }

    /// Who is furthest behind.
    pub(crate) fn slowest(&self) -> Option<&str> {
        self.reached.iter().min_by_key(|(_, stamp)| **stamp).map(|(node, _)| node.as_str())
    }
}
