//! The first pass: where in the picture something stands out like a line. One look at every byte, so it is written for
//! vectors: whole rows at a time, plain loops, no branches but one a block.

use crate::channel::Levels;
use wire::{Frame, PeaksPer};

/// Pixels that are passed over together where none is lit.
const BLOCK: usize = 64;
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
    /// Of one row: not zero where it is lit.
    excess: Vec<u8>,
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
            excess: Vec::new(),
            last_run: Vec::new(),
            runs: Vec::new(),
        }
    }

    /// Fills `runs` with all that rises more than `threshold` levels above both sides.
    pub(crate) fn run(&mut self, frame: &Frame, levels: &Levels, peaks_per: PeaksPer, threshold: u8) {
        self.runs.clear();
        self.excess.clear();
        self.excess.resize((frame.width as usize).next_multiple_of(BLOCK), 0);
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
            self.arch.dispatch(Excess { centre: shifted(far), sides, threshold, out: &mut self.excess[..width] });
            for_each_lit(&self.excess, |u| match self.runs.last_mut() {
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
            self.arch.dispatch(Excess { centre: row(v), sides, threshold, out: &mut self.excess[..width] });
            let v = v as u32;
            for_each_lit(&self.excess, |u| {
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

/// By how much more than `threshold` each pixel stands above the larger of its two sides, where a side is the darker of a
/// near and a far pixel: a step has one bright side and gives nothing, and a second line at one of the distances hides
/// none. (A struct to be compiled for each kind of vectors; a closure would be compiled once, for the least of them.)
struct Excess<'a> {
    centre: &'a [u8],
    /// Left (or above), near and far, and right (or below) likewise.
    sides: [&'a [u8]; 4],
    threshold: u8,
    out: &'a mut [u8],
}

impl pulp::NullaryFnOnce for Excess<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { centre, sides, threshold, out } = self;
        let [left_near, left_far, right_near, right_far] = sides.map(|side| &side[..out.len()]);
        let centre = &centre[..out.len()];
        for i in 0..out.len() {
            let side = left_near[i].min(left_far[i]).max(right_near[i].min(right_far[i]));
            out[i] = centre[i].saturating_sub(side).saturating_sub(threshold);
        }
    }
}

/// The places of all bytes that are not zero; there are few.
fn for_each_lit(excess: &[u8], mut lit: impl FnMut(u32)) {
    let (blocks, _) = excess.as_chunks::<BLOCK>();
    for (block, pixels) in blocks.iter().enumerate() {
        let (words, _) = pixels.as_chunks::<8>();
        if words.iter().fold(0, |any, bytes| any | u64::from_le_bytes(*bytes)) == 0 {
            continue;
        }
        for (word, bytes) in words.iter().enumerate() {
            let mut left = u64::from_le_bytes(*bytes);
            while left != 0 {
                let byte = left.trailing_zeros() / 8;
                lit((block * BLOCK + word * 8) as u32 + byte);
                left &= !(0xff << (8 * byte));
            }
        }
    }
}
