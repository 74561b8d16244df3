//! The second pass: where something stands out, to a fraction of a pixel.

use crate::Config;
use crate::channel::LaserChannel;
use crate::gaussian::ITERATIONS;
use crate::lateral::LinePeak;
use crate::measure::Candidate;
use crate::refusal::{Reason, Refusals};
use crate::search::Run;
use wire::{Frame, PeaksPer};

/// Around a stretch that stands out; enough for lines up to about 2 px wide, wider ones are read again.
const REACH_PX: usize = 14;

/// So many runs are measured together.
pub(crate) const RUNS: usize = 32;

/// The second pass over one picture.
pub(crate) struct Measuring<'a> {
    pub config: &'a Config,
    pub channel: &'a LaserChannel,
    pub frame: &'a Frame,
    pub peaks_per: PeaksPer,
    /// Noise of a pixel in grey levels.
    pub sigma: f32,
    /// Kept for their memory.
    pub candidates: &'a mut Vec<Candidate>,
    /// What was found so far.
    pub peaks: &'a mut Vec<LinePeak>,
    pub refusals: &'a mut Refusals,
    /// A line, and up to where on it all belongs to its last peak.
    pub taken_to: (u32, f32),
}

impl Measuring<'_> {
    /// Measures what stands out next, in order along the lines. (Plain loops: closures would not be compiled for the
    /// vectors.)
    #[inline(always)]
    fn measure(&mut self, runs: &[Run]) {
        if self.candidates.len() < runs.len() {
            self.candidates.resize_with(runs.len(), Candidate::default);
        }
        let candidates = &mut self.candidates[..runs.len()];
        for (candidate, run) in candidates.iter_mut().zip(runs) {
            candidate.restart(*run);
        }
        let widest = (4.0 * self.config.max_width_px) as usize + REACH_PX;
        // A window that proves too small is read again as large as the widest line needs.
        for near in [true, false] {
            for candidate in candidates.iter_mut() {
                if candidate.result == Err(Reason::Wide) {
                    let run = candidate.run;
                    let reach = if near { REACH_PX + (run.last - run.first) as usize } else { widest };
                    candidate.window.read(self.channel, self.frame, self.peaks_per, run, reach);
                    candidate.start(self.sigma, self.config);
                }
            }
            for _ in 0..ITERATIONS {
                for candidate in candidates.iter_mut() {
                    candidate.step(self.sigma, self.config);
                }
            }
            for candidate in candidates.iter_mut() {
                candidate.settle(self.sigma, self.config);
            }
        }
        self.take(runs);
    }

    /// The peaks among the candidates, but for what stands out beside a clipped core, or in a ragged flank: that belongs to
    /// the peak before it.
    #[inline(always)]
    fn take(&mut self, runs: &[Run]) {
        for (run, candidate) in runs.iter().zip(self.candidates.iter()) {
            if run.line != self.taken_to.0 {
                self.taken_to = (run.line, f32::NEG_INFINITY);
            }
            let taken_to = &mut self.taken_to.1;
            if (run.first as f32) < *taken_to {
                continue;
            }
            match candidate.result {
                Ok(peak) if peak.position < *taken_to => {}
                Ok(peak) => {
                    *taken_to = peak.ends;
                    self.peaks.push(LinePeak { line: run.line, best: false, peak });
                }
                Err(reason) => self.refusals.count(reason),
            }
        }
    }
}

/// To be compiled for each kind of vectors: without them, rounding is a call into a library.
pub(crate) struct Measure<'a, 'b> {
    pub measuring: &'a mut Measuring<'b>,
    pub runs: &'a [Run],
}

impl pulp::NullaryFnOnce for Measure<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.measuring.measure(self.runs);
    }
}
