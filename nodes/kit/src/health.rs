//! A node's account of itself.

use crate::ports::SharedCounts;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};
use wire::{Header, Health, InputHealth, Latencies, Refusal};

/// What is gathered between two reports.
pub(crate) struct Account {
    pub(crate) inputs: Vec<(String, SharedCounts)>,
    pub(crate) sent: Arc<AtomicU64>,
    /// Since the last report.
    recent: Latencies,
    latencies: Latencies,
    pub(crate) finished: Header,
    refused: BTreeMap<String, u64>,
    busy: Duration,
    woke: Option<Instant>,
    reported: Option<Instant>,
}

impl Account {
    pub(crate) fn new() -> Self {
        Self {
            inputs: Vec::new(),
            sent: Arc::default(),
            recent: Latencies::default(),
            latencies: Latencies::default(),
            finished: Header::default(),
            refused: BTreeMap::new(),
            busy: Duration::ZERO,
            woke: None,
            reported: None,
        }
    }

    pub(crate) fn refuse(&mut self, reason: &str, count: u64) {
        match self.refused.get_mut(reason) {
            Some(total) => *total += count,
            None => {
                self.refused.insert(reason.to_owned(), count);
            }
        }
    }

    /// Notes how old a result was when it was done.
    pub(crate) fn took(&mut self, nanos: i64) {
        self.recent.note(nanos);
    }

    pub(crate) fn rests(&mut self) {
        if let Some(woke) = self.woke.take() {
            self.busy += woke.elapsed();
        }
    }

    pub(crate) fn works(&mut self, time: Duration) {
        self.busy += time;
    }

    pub(crate) fn wakes(&mut self) {
        self.woke = Some(Instant::now());
    }

    /// The report, when one is due.
    pub(crate) fn due(&mut self, node: &str, every: Duration) -> Option<Health> {
        if self.reported.is_some_and(|at| at.elapsed() < every) {
            return None;
        }
        self.reported = Some(Instant::now());
        Some(self.report(node))
    }

    pub(crate) fn report(&mut self, node: &str) -> Health {
        let recent = std::mem::take(&mut self.recent);
        self.latencies.add(&recent);
        let [latency_p50_nanos, latency_p99_nanos] = [0.5, 0.99].map(|share| recent.percentile(share).unwrap_or(0));
        Health {
            header: self.finished.derived(),
            node: node.to_owned(),
            inputs: self.inputs.iter().map(|(key, counts)| input_health(key, counts)).collect(),
            published: self.sent.load(Ordering::Relaxed),
            refused: self.refused.iter().map(|(reason, &count)| Refusal { reason: reason.clone(), count }).collect(),
            latency_p50_nanos,
            latency_p99_nanos,
            latencies: self.latencies.clone(),
            cpu_nanos: cpu_nanos().unwrap_or(0),
            busy_nanos: self.busy.as_nanos() as i64,
        }
    }
}

fn input_health(key: &str, counts: &SharedCounts) -> InputHealth {
    let counts = counts.lock().unwrap_or_else(PoisonError::into_inner);
    InputHealth {
        key: key.to_owned(),
        received: counts.received,
        lost: counts.lost,
        refused: counts.refused + counts.repeated,
    }
}

/// Processor time of this process: fields 14 and 15 of /proc/self/stat (proc(5)), in ticks of 10 ms.
fn cpu_nanos() -> Option<i64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
    let user: i64 = fields.next()?.parse().ok()?;
    let system: i64 = fields.next()?.parse().ok()?;
    const TICK_NANOS: i64 = 10_000_000;
    Some((user + system) * TICK_NANOS)
}
