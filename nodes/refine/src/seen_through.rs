//! Points that hang where other strokes looked through.
//!
//! Between the camera and what it measured there is nothing. So a place through which many lines of sight pass, and where
//! few of them end, is empty, and what ends there was measured from a frame that is not where it is taken to be, or is
//! the glint of another surface. (Space carving as in Curless and Levoy 1996, "A volumetric method for building complex
//! models from range images", section 4.3, with points for evidence.)

use crate::refinement::RefinedFrame;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// Evidence is gathered in cells of this size, in larger ones when the scan is too large for that.
const CELL_M: f32 = 1e-3;
const MOST_CELLS: f32 = 1.2e7;
/// Lines of sight that are followed: enough to fill the cells.
const LINES: usize = 200_000;
/// A line is followed over this stretch before its end. Nearer to it, one that grazes would still run in the surface
/// itself; farther away, nothing has been measured wrongly by so much that would not be an island by itself.
const STRETCH_M: [f32; 2] = [2e-3, 30e-3];
/// A place is empty when so many times more lines pass through than end there; and one more.
const PASSING: u32 = 2;
/// Points beyond these shares of the others are not followed, so that one wild point makes no huge grid.
const OUTSIDE: f64 = 0.002;

/// Takes such points out of the frames; returns how many.
pub(crate) fn carve(frames: &mut [RefinedFrame]) -> usize {
    let all: usize = frames.iter().map(|frame| frame.points.len()).sum();
    let stride = (all / LINES).max(1);
    let Some(grid) = Grid::around(frames, stride) else { return 0 };
    frames.par_iter().for_each(|frame| {
        let eye = eye(frame);
        placed(frame).step_by(stride).for_each(|end| grid.follow(&eye, &end));
    });
    let carved = |frame: &mut RefinedFrame| {
        let is_kept: Vec<bool> = placed(frame).map(|place| !grid.is_empty(&place)).collect();
        let gone = is_kept.iter().filter(|kept| !**kept).count();
        if gone > 0 {
            let kept = frame.points.iter().zip(is_kept).filter(|(_, kept)| *kept);
            frame.points = kept.map(|(point, _)| *point).collect();
        }
        gone
    };
    frames.par_iter_mut().map(carved).sum()
}

fn eye(frame: &RefinedFrame) -> Vector3<f32> {
    frame.pose.pose.translation.vector.cast()
}

fn placed(frame: &RefinedFrame) -> impl ExactSizeIterator<Item = Vector3<f32>> + '_ {
    let rotation = frame.pose.pose.rotation.to_rotation_matrix().into_inner().cast::<f32>();
    let eye = eye(frame);
    frame.points.iter().map(move |point| rotation * Vector3::from(point.position_m) + eye)
}

/// How many lines end in each cell, and how many pass through.
struct Grid {
    low: Vector3<f32>,
    cell_m: f32,
    size: [usize; 3],
    ends: Vec<AtomicU32>,
    passes: Vec<AtomicU32>,
}

impl Grid {
    fn around(frames: &[RefinedFrame], stride: usize) -> Option<Self> {
        let places: Vec<Vector3<f32>> =
            frames.par_iter().flat_map_iter(|frame| placed(frame).step_by(stride)).collect();
        let bounds = |axis: usize| {
            let mut along: Vec<f32> = places.iter().map(|place| place[axis]).collect();
            let outside = (along.len() as f64 * OUTSIDE) as usize;
            let last = along.len().checked_sub(1 + outside)?;
            let low = *along.select_nth_unstable_by(outside, f32::total_cmp).1;
            Some([low, *along.select_nth_unstable_by(last, f32::total_cmp).1])
        };
        let [x, y, z] = [bounds(0)?, bounds(1)?, bounds(2)?];
        let low = Vector3::new(x[0], y[0], z[0]);
        let extent = Vector3::new(x[1], y[1], z[1]) - low;
        if !extent.iter().all(|e| e.is_finite()) {
            return None;
        }
        let volume: f32 = extent.iter().map(|e| e + CELL_M).product();
        let cell_m = CELL_M.max((volume / MOST_CELLS).cbrt());
        let size: [usize; 3] = std::array::from_fn(|axis| (extent[axis] / cell_m) as usize + 1);
        let cells = size.iter().product();
        let counts = || std::iter::repeat_with(AtomicU32::default).take(cells).collect();
        Some(Self { low, cell_m, size, ends: counts(), passes: counts() })
    }

    fn cell(&self, place: &Vector3<f32>) -> Option<usize> {
        let off = (place - self.low) / self.cell_m;
        let [x, y, z]: [usize; 3] = std::array::from_fn(|axis| off[axis] as usize);
        let inside = off.iter().all(|o| *o >= 0.0) && x < self.size[0] && y < self.size[1] && z < self.size[2];
        inside.then(|| (z * self.size[1] + y) * self.size[0] + x)
    }

    /// Sums of whole numbers, so the order of the threads does not show.
    fn follow(&self, eye: &Vector3<f32>, end: &Vector3<f32>) {
        if let Some(cell) = self.cell(end) {
            self.ends[cell].fetch_add(1, Ordering::Relaxed);
        }
        let Some(back) = (eye - end).try_normalize(0.0) else { return };
        let mut before = None;
        let [first, last] = STRETCH_M;
        for step in 0..((last - first) / self.cell_m) as usize {
            let cell = self.cell(&(end + back * (first + step as f32 * self.cell_m)));
            if let Some(cell) = cell
                && before != Some(cell)
            {
                self.passes[cell].fetch_add(1, Ordering::Relaxed);
            }
            before = cell;
        }
    }

    fn is_empty(&self, place: &Vector3<f32>) -> bool {
        let Some(cell) = self.cell(place) else { return false };
        let [ends, passes] = [&self.ends, &self.passes].map(|counts| counts[cell].load(Ordering::Relaxed));
        passes > PASSING * ends + 1
    }
}
