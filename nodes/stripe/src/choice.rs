//! Which of the measured peaks are taken: those that a line goes on from, of them the largest of each row (or column), and
//! the one that is best.

use crate::Config;
use crate::lateral::LinePeak;
use crate::refusal::{Reason, Refusals};
use crate::support;
use std::cmp::Ordering;

/// Buffers, kept from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct Choice {
    support: Vec<u8>,
    ranks: Vec<Rank>,
    crowded: Vec<bool>,
}

/// Amplitude, and the place among the peaks of its line: of equals, the later one is kept.
type Rank = (f32, usize);

fn by_amplitude(a: &Rank, b: &Rank) -> Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

impl Choice {
    /// Leaves out what is not taken and counts it; `peaks` are sorted by line and position.
    pub(crate) fn choose(&mut self, peaks: &mut Vec<LinePeak>, config: &Config, refusals: &mut Refusals) {
        self.refuse_the_lonely(peaks, config, refusals);
        // After the grains, which must not push the line out of a row.
        self.refuse_the_small(peaks, config.max_peaks_per_line, refusals);
        mark_the_best(peaks, config.tie_fraction);
    }

    /// Leaves out what no line goes on from.
    fn refuse_the_lonely(&mut self, peaks: &mut Vec<LinePeak>, config: &Config, refusals: &mut Refusals) {
        support::count(peaks, config.link_px, &mut self.support);
        let mut support = self.support.iter();
        peaks.retain(|_| {
            let holds = support.next().is_some_and(|lines| usize::from(*lines) >= config.min_support_lines);
            if !holds {
                refusals.count(Reason::Alone);
            }
            holds
        });
    }

    /// Keeps the largest of each line, at most `most`.
    fn refuse_the_small(&mut self, peaks: &mut Vec<LinePeak>, most: usize, refusals: &mut Refusals) {
        self.crowded.clear();
        for line in peaks.chunk_by(|a, b| a.line == b.line) {
            let ranks = || line.iter().enumerate().map(|(place, p)| (p.peak.amplitude, place));
            let Some(surplus) = line.len().checked_sub(most).filter(|surplus| *surplus > 0) else {
                self.crowded.resize(self.crowded.len() + line.len(), false);
                continue;
            };
            self.ranks.clear();
            self.ranks.extend(ranks());
            let least = *self.ranks.select_nth_unstable_by(surplus, by_amplitude).1;
            self.crowded.extend(ranks().map(|rank| by_amplitude(&rank, &least).is_lt()));
        }
        let mut crowded = self.crowded.iter();
        peaks.retain(|_| {
            let refused = crowded.next().is_some_and(|crowded| *crowded);
            if refused {
                refusals.count(Reason::Crowded);
            }
            !refused
        });
    }
}

/// The largest of each line is its best.
fn mark_the_best(peaks: &mut [LinePeak], tie_fraction: f32) {
    for line in peaks.chunk_by_mut(|a, b| a.line == b.line) {
        let Some(largest) = line.iter().map(|p| p.peak).max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)) else {
            continue;
        };
        let enough = (1.0 - tie_fraction) * largest.amplitude;
        // How high a clipped peak really is, nobody knows.
        let ties = |p: &&mut LinePeak| p.peak.amplitude >= enough || (p.peak.clipped && largest.clipped);
        if let Some(best) = line.iter_mut().find(ties) {
            best.best = true;
        }
    }
}
