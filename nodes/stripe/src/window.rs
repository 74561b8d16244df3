//! The pixels of one line (a row or a column) around a stretch that stands out.

use crate::channel::{LaserChannel, Sample};
use crate::refusal::Reason;
use crate::search::Run;
use wire::{Frame, PeaksPer};

/// Samples `first..first + samples.len()` of a line.
#[derive(Debug, Default)]
pub(crate) struct Window {
    pub samples: Vec<Sample>,
    /// The pixel of the first sample.
    pub first: usize,
    /// The window was cut off by the border of the picture on either side.
    pub cut: bool,
}

/// The background on both sides of a peak, as a straight line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Background {
    /// At the peak.
    pub level: f32,
    /// Per pixel.
    pub slope: f32,
    /// Variance of the slope, in units of a pixel's variance.
    pub slope_variance: f32,
}

/// Pixels that are averaged for the background on each side.
const SIDE_PX: usize = 6;
/// A side with fewer tells nothing.
const MIN_SIDE_PX: usize = 2;

impl Window {
    /// Reads the pixels of `run` and `reach` more on each side.
    #[inline(always)]
    pub(crate) fn read(&mut self, channel: &LaserChannel, frame: &Frame, peaks_per: PeaksPer, run: Run, reach: usize) {
        let line = run.line as usize;
        let length = match peaks_per {
            PeaksPer::Row => frame.width as usize,
            PeaksPer::Column => frame.height as usize,
        };
        let (first, last) = (run.first as usize, run.last as usize);
        let end = (last + reach + 1).min(length);
        self.first = first.saturating_sub(reach);
        self.cut = first < reach || last + reach >= length;
        channel.read(frame, peaks_per, line, self.first..end, &mut self.samples);
    }

    /// The last pixel of the clipped stretch that `last` lies in or before; itself when none is there.
    #[inline(always)]
    pub(crate) fn clipped_to(&self, last: u32) -> u32 {
        let behind = &self.samples[last as usize + 1 - self.first..];
        last + behind.iter().take_while(|s| s.clipped).count() as u32
    }

    /// Why there is no peak where the window ends before the background.
    #[inline(always)]
    pub(crate) fn outside(&self) -> Reason {
        if self.cut { Reason::Edge } else { Reason::Wide }
    }

    /// Mean of the samples `from..to`, and how many there are.
    #[inline(always)]
    fn mean(&self, from: usize, to: usize) -> (f32, usize) {
        let side = &self.samples[from.min(to)..to];
        (side.iter().map(|s| s.grey).sum::<f32>() / side.len() as f32, side.len())
    }

    /// The outermost level on each side.
    #[inline(always)]
    pub(crate) fn ends(&self) -> [f32; 2] {
        let n = self.samples.len();
        let few = SIDE_PX.min(n);
        [self.mean(0, few).0, self.mean(n - few, n).0]
    }

    /// The background at `centre`, from the pixels farther than `clear` from it; `None` where the window ends before.
    #[inline(always)]
    pub(crate) fn background(&self, centre: f32, clear: f32) -> Option<Background> {
        let n = self.samples.len();
        let left_end = (centre - clear).floor() + 1.0;
        let right_start = (centre + clear).ceil();
        if left_end < MIN_SIDE_PX as f32 || right_start + MIN_SIDE_PX as f32 > n as f32 {
            return None;
        }
        let (left_end, right_start) = (left_end as usize, right_start as usize);
        let (left, left_px) = self.mean(left_end.saturating_sub(SIDE_PX), left_end);
        let (right, right_px) = self.mean(right_start, (right_start + SIDE_PX).min(n));
        let left_at = left_end as f32 - 0.5 * (left_px as f32 + 1.0);
        let right_at = right_start as f32 + 0.5 * (right_px as f32 - 1.0);
        let slope = (right - left) / (right_at - left_at);
        let slope_variance = (1.0 / left_px as f32 + 1.0 / right_px as f32) / (right_at - left_at).powi(2);
        Some(Background { level: left + slope * (centre - left_at), slope, slope_variance })
    }
}
