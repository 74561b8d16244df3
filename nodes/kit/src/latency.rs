//! Percentiles of now - stamp.

/// Latencies since the last report; a sample of the newest when there are very many.
#[derive(Debug, Default)]
pub(crate) struct Latencies {
    nanos: Vec<i64>,
    next: usize,
}

const KEPT: usize = 4096;

impl Latencies {
    pub(crate) fn note(&mut self, nanos: i64) {
        if self.nanos.len() < KEPT {
            self.nanos.push(nanos);
        } else {
            self.nanos[self.next % KEPT] = nanos;
            self.next += 1;
        }
    }

    /// Median and 99th percentile, and starts anew; zeros when nothing was noted.
    pub(crate) fn take(&mut self) -> [i64; 2] {
        self.next = 0;
        let mut nanos = std::mem::take(&mut self.nanos);
        nanos.sort_unstable();
        let at = |share: f64| nanos.get(((nanos.len() as f64 - 1.0) * share).max(0.0) as usize).copied().unwrap_or(0);
        [at(0.5), at(0.99)]
    }
}
