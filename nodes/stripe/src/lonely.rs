//! What is alone is not measured: a coarse look, before the second pass, at what stands out in the lines around.

use crate::Config;
use crate::refusal::{Reason, Refusals};
use crate::search::Run;
use crate::support::REACH;

/// Which cells of each line something stands in, a bit each.
#[derive(Debug, Default)]
pub(crate) struct Cells {
    cell_px: u32,
    lines: Vec<u64>,
}

/// Buffers, kept from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct Lonely {
    all: Cells,
    held: Cells,
}

impl Cells {
    /// Nothing in so many lines of such a length; cells are as short as 64 of them allow.
    fn clear(&mut self, lines: u32, length_px: u32, least_px: f32) {
        self.cell_px = (least_px.ceil() as u32).max(length_px.div_ceil(u64::BITS)).max(1);
        self.lines.clear();
        self.lines.resize(lines as usize, 0);
    }

    fn of(&self, run: &Run) -> u64 {
        let [first, last] = [run.first, run.last].map(|px| (px / self.cell_px).min(u64::BITS - 1));
        (u64::MAX >> (u64::BITS - 1 - last)) & (u64::MAX << first)
    }

    fn mark(&mut self, run: &Run) {
        let cells = self.of(run);
        self.lines[run.line as usize] |= cells;
    }

    /// In how many of the lines around the run something stands no more than two cells aside.
    fn around(&self, run: &Run) -> usize {
        let cells = self.of(run);
        let near = cells | cells << 1 | cells << 2 | cells >> 1 | cells >> 2;
        let line = run.line as usize;
        let (from, to) = (line.saturating_sub(REACH), (line + REACH + 1).min(self.lines.len()));
        let holds = |range: std::ops::Range<usize>| self.lines[range].iter().filter(|there| *there & near != 0).count();
        holds(from..line) + holds(line + 1..to)
    }
}

impl Lonely {
    /// Leaves out what will be alone wherever its peak turns out to be, unless it stands beside what may be taken and so may
    /// hold it: what is taken in the end is the same.
    pub(crate) fn refuse(&mut self, runs: &mut Vec<Run>, size: [u32; 2], config: &Config, refusals: &mut Refusals) {
        let [lines, length_px] = size;
        // A peak is at most so far from where it stood out; two may come nearer to one another, over four lines.
        let stray_px = 3.0 * config.max_width_px + 2.0;
        let least_px = 0.5 * (2.0 * stray_px + REACH as f32 * config.link_px);
        for cells in [&mut self.all, &mut self.held] {
            cells.clear(lines, length_px, least_px);
        }
        runs.iter().for_each(|run| self.all.mark(run));
        let is_held = |all: &Cells, run: &Run| all.around(run) >= config.min_support_lines;
        runs.iter().filter(|run| is_held(&self.all, run)).for_each(|run| self.held.mark(run));
        let before = runs.len();
        // Most of what is kept is a line, and settled by the first look.
        runs.retain(|run| self.held.around(run) > 0 || is_held(&self.all, run));
        (runs.len()..before).for_each(|_| refusals.count(Reason::Alone));
    }
}
