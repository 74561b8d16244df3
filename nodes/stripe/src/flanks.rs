//! Where a line falls to half its height, and what that tells of one whose top is clipped.

use crate::gaussian::CLEAR_PX;
use crate::measure::Peak;
use crate::window::Window;

/// Width at half height of a Gaussian in standard deviations: 2 sqrt(2 ln 2).
const HALF_HEIGHT: f32 = 2.354_82;

/// The flanks at half height.
pub(crate) struct Flanks {
    pub left: f32,
    pub right: f32,
    /// Grey levels a pixel, both positive.
    slopes: [f32; 2],
    /// Half the height on each side.
    heights: [f32; 2],
}

impl Flanks {
    /// Halfway between them.
    #[inline(always)]
    pub(crate) fn middle(&self) -> f32 {
        0.5 * (self.left + self.right)
    }

    /// Standard deviation of a Gaussian that is as wide.
    #[inline(always)]
    pub(crate) fn width(&self) -> f32 {
        (self.right - self.left) / HALF_HEIGHT
    }
}

/// Outwards from the top to half its height above the background of each side.
#[inline(always)]
pub(crate) fn find_flanks(window: &Window, top: usize) -> Option<Flanks> {
    let samples = &window.samples;
    let peak = samples[top].grey;
    let [left, right] = window.ends();
    // A side that is as bright as this is another line: the darker side serves for both.
    let other_line = 0.5 * (peak + left.min(right));
    let side = |level: f32| if level > other_line { left.min(right) } else { level };
    let halves = [0.5 * (peak + side(left)), 0.5 * (peak + side(right))];
    let mut i = top;
    while samples[i].grey > halves[0] {
        i = i.checked_sub(1)?;
    }
    let mut j = top;
    while samples.get(j)?.grey > halves[1] {
        j += 1;
    }
    if i == top || j == top {
        return None;
    }
    let slopes = [samples[i + 1].grey - samples[i].grey, samples[j - 1].grey - samples[j].grey];
    Some(Flanks {
        left: i as f32 + (halves[0] - samples[i].grey) / slopes[0],
        right: j as f32 - (halves[1] - samples[j].grey) / slopes[1],
        slopes,
        heights: halves.map(|half| peak - half),
    })
}

/// A clipped line: the middle between its flanks, because its top is unknown. `None` when the window ends before the
/// background.
#[inline(always)]
pub(crate) fn plateau(window: &Window, flanks: &Flanks, top: f32, sigma: f32) -> Option<Peak> {
    let position = flanks.middle();
    let background = window.background(position, flanks.right - position + 1.0 + CLEAR_PX)?;
    // Each flank lies between two pixels of independent noise; averaged over the phase, 2/3 of a pixel's variance.
    let flank = |value: f32, slope: f32| (2.0 / 3.0) * (value / slope).powi(2);
    let sum = |values: [f32; 2]| 0.25 * (flank(values[0], flanks.slopes[0]) + flank(values[1], flanks.slopes[1]));
    Some(Peak {
        position,
        amplitude: top - background.level,
        width: flanks.width(),
        noise_variance: sum([sigma; 2]),
        speckle_variance: sum(flanks.heights),
        clipped: true,
        ends: flanks.right,
    })
}
