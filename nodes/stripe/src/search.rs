//! The first pass: where in the picture something stands out like a line. One look at every byte, so it is written for
//! vectors: whole rows at a time, plain loops, no branches but one a block.

use crate::channel::Levels;
use wire::{Frame, PeaksPer};

/// Pixels that share one look at their largest contrast.
const BLOCK: usize = 32;
/// Rows that are converted in one go (row by row, between comparisons, the memory cannot be read ahead).
const BATCH: usize = 16;
/// Lit stretches of one line that are closer belong together.
const JOIN_PX: u32 = 2;

/// A stretch of one line (a row or a column) that stands out: pixels `first..=last`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Run {
    pub line: u32,
    pub first: u32,
    pub last: u32,
}

/// Buffers of the search, kept from frame to frame.
#[derive(Debug)]
pub(crate) struct Search {
    /// The vectors that this machine has; the row loops are compiled for each kind.
    pub arch: pulp::Arch,
    /// How far aside the background is looked for, in pixels: near and far.
    reach: [usize; 2],
    /// Levels: one row with its borders (peaks per row) or a ring of rows (peaks per column).
    levels: Vec<u8>,
    contrast: Vec<u8>,
    /// Which run of a column was the last (peaks per column).
    last_run: Vec<u32>,
    /// What was found, by line and along each line.
    pub runs: Vec<Run>,
}

impl Search {
    /// `max_width_px` is the standard deviation of the widest line that must be seen.
    pub(crate) fn new(max_width_px: f32) -> Self {
        let near = (0.4 * max_width_px).ceil() as usize + 3;
        // Half the width at half height, and the foot of the flank.
        let far = (1.2 * max_width_px).ceil() as usize + 6;
        Self {
            arch: pulp::Arch::new(),
            reach: [near, far],
            levels: Vec::new(),
            contrast: Vec::new(),
            last_run: Vec::new(),
            runs: Vec::new(),
        }
    }

    /// Fills `runs` with all that rises more than `threshold` levels above both sides.
    pub(crate) fn run(&mut self, frame: &Frame, levels: &Levels, peaks_per: PeaksPer, threshold: u8) {
        self.runs.clear();
        self.contrast.clear();
        self.contrast.resize((frame.width as usize).next_multiple_of(BLOCK), 0);
        match peaks_per {
            PeaksPer::Row => self.rows(frame, levels, threshold),
            PeaksPer::Column => self.columns(frame, levels, threshold),
        }
    }

    fn rows(&mut self, frame: &Frame, levels: &Levels, threshold: u8) {
        let [near, far] = self.reach;
        let (width, stride) = (frame.width as usize, frame.stride as usize);
        self.levels.clear();
        self.levels.resize(width + 2 * far, 0);
        for (v, row) in frame.data.chunks(stride).take(frame.height as usize).enumerate() {
            levels.fill(self.arch, row, &mut self.levels[far..far + width]);
            let (first, last) = (self.levels[far], self.levels[far + width - 1]);
            self.levels[..far].fill(first);
            self.levels[far + width..].fill(last);
            let shifted = |by: usize| &self.levels[by..by + width];
            let sides = [shifted(far - near), shifted(0), shifted(far + near), shifted(2 * far)];
            contrast(self.arch, shifted(far), sides, &mut self.contrast[..width]);
            lit_pixels(self.arch, &self.contrast, threshold, |u| match self.runs.last_mut() {
                Some(run) if run.line == v as u32 && u <= run.last + JOIN_PX => run.last = u,
                _ => self.runs.push(Run { line: v as u32, first: u, last: u }),
            });
        }
    }

    /// Down the picture row by row, as it lies in memory: a ring holds the rows that a pixel is compared with.
    fn columns(&mut self, frame: &Frame, levels: &Levels, threshold: u8) {
        const NONE: u32 = u32::MAX;
        let [near, far] = self.reach;
        let (width, height, stride) = (frame.width as usize, frame.height as usize, frame.stride as usize);
        let ring = 2 * far + BATCH;
        let pitch = width.next_multiple_of(64) + 64;
        self.levels.clear();
        self.levels.resize(ring * pitch, 0);
        self.last_run.clear();
        self.last_run.resize(width, NONE);
        let mut filled = 0;
        for v in 0..height {
            let needed = v + far + 1;
            let ahead = if filled < height.min(needed) { needed + BATCH - 1 } else { needed };
            while filled < height.min(ahead) {
                let at = filled % ring * pitch;
                levels.fill(self.arch, &frame.data[filled * stride..], &mut self.levels[at..at + width]);
                filled += 1;
            }
            let row = |v: usize| {
                let at = v.min(height - 1) % ring * pitch;
                &self.levels[at..at + width]
            };
            let sides = [row(v.saturating_sub(near)), row(v.saturating_sub(far)), row(v + near), row(v + far)];
            contrast(self.arch, row(v), sides, &mut self.contrast[..width]);
            let v = v as u32;
            lit_pixels(self.arch, &self.contrast, threshold, |u| {
                let last = &mut self.last_run[u as usize];
                match self.runs.get_mut(*last as usize) {
                    Some(run) if v <= run.last + JOIN_PX => run.last = v,
                    _ => {
                        *last = self.runs.len() as u32;
                        self.runs.push(Run { line: u, first: v, last: v });
                    }
                }
            });
        }
        self.runs.sort_unstable();
    }
}

/// How far each pixel stands above the larger of its two sides, where a side is the darker of a near and a far pixel: a
/// step has one bright side and gives nothing, and a second line at one of the distances hides none.
fn contrast(arch: pulp::Arch, centre: &[u8], sides: [&[u8]; 4], out: &mut [u8]) {
    arch.dispatch(
        #[inline(always)]
        || {
            let [left_near, left_far, right_near, right_far] = sides.map(|side| &side[..out.len()]);
            let centre = &centre[..out.len()];
            for i in 0..out.len() {
                let side = left_near[i].min(left_far[i]).max(right_near[i].min(right_far[i]));
                out[i] = centre[i].saturating_sub(side);
            }
        },
    );
}

fn lit_pixels(arch: pulp::Arch, contrast: &[u8], threshold: u8, mut lit: impl FnMut(u32)) {
    let (blocks, _) = contrast.as_chunks::<BLOCK>();
    for (block, pixels) in blocks.iter().enumerate() {
        let largest = arch.dispatch(
            #[inline(always)]
            || pixels.iter().fold(0, |max: u8, &c| max.max(c)),
        );
        if largest > threshold {
            for (i, &c) in pixels.iter().enumerate() {
                if c > threshold {
                    lit((block * BLOCK + i) as u32);
                }
            }
        }
    }
}
