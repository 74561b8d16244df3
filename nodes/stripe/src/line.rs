//! The second pass: all peaks of one line (a row or a column), each to a fraction of a pixel.

use crate::Config;
use crate::channel::LaserChannel;
use crate::lateral::LinePeak;
use crate::measure::{Peak, measure};
use crate::refusal::{Reason, Refusals};
use crate::search::Run;
use crate::window::Window;
use wire::{Frame, PeaksPer};

/// Around a stretch that stands out; enough for lines up to about 2 px wide, wider ones are read again.
const REACH_PX: usize = 14;

/// The lines of one picture.
pub(crate) struct Lines<'a> {
    pub config: &'a Config,
    pub channel: &'a LaserChannel,
    pub frame: &'a Frame,
    pub peaks_per: PeaksPer,
    /// Noise of a pixel in grey levels.
    pub sigma: f32,
    pub window: &'a mut Window,
    /// What was found so far.
    pub peaks: &'a mut Vec<LinePeak>,
    pub refusals: &'a mut Refusals,
}

impl Lines<'_> {
    /// The peaks of one line, from what stands out in it.
    #[inline(always)]
    fn line(&mut self, runs: &[Run]) {
        // What stands out beside a clipped core, or in a ragged flank, belongs to the peak before it.
        let mut taken_to = f32::NEG_INFINITY;
        for &run in runs {
            if (run.first as f32) < taken_to {
                continue;
            }
            match self.peak(run) {
                Ok(peak) if peak.position < taken_to => {}
                Ok(peak) => {
                    taken_to = peak.ends;
                    self.peaks.push(LinePeak { line: run.line, best: false, peak });
                }
                Err(reason) => self.refusals.count(reason),
            }
        }
    }

    /// One peak; a window that proves too small is read again as large as the widest line needs.
    #[inline(always)]
    fn peak(&mut self, mut run: Run) -> Result<Peak, Reason> {
        let widest = (4.0 * self.config.max_width_px) as usize + REACH_PX;
        let mut result = Err(Reason::Shapeless);
        for reach in [REACH_PX + (run.last - run.first) as usize, widest] {
            self.window.read(self.channel, self.frame, self.peaks_per, run, reach);
            run.last = self.window.clipped_to(run.last);
            result = measure(self.window, run, self.sigma, self.config);
            if result != Err(Reason::Wide) {
                break;
            }
        }
        result
    }
}

/// One line, to be compiled for each kind of vectors: without them, rounding is a call into a library.
pub(crate) struct MeasureLine<'a, 'b> {
    pub lines: &'a mut Lines<'b>,
    pub runs: &'a [Run],
}

impl pulp::NullaryFnOnce for MeasureLine<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.lines.line(self.runs);
    }
}
