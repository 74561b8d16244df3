//! Automatic gain: a pure function of the picture without its noise, so that no frame depends on the one before.

use super::OpticsSection;
use super::shade::{Lighting, Patches};
use super::stage::Stage;
use geometry::VisibilityBuffer;

/// Every so many pixels and rows are metered.
const METERED_EVERY: usize = 16;
/// The share of what is metered that may be brighter than the target.
const BRIGHTER: f32 = 0.05;
/// On the laser's line, where highlights are many and only its best part counts.
const BRIGHTER_ON_LINE: f32 = 0.1;

/// From the light along the ridge of the laser's line.
pub(super) fn of_line(section: &OpticsSection, ridge: &[f32], levels: &mut Vec<f32>) -> f32 {
    let strongest = section.laser.response.iter().fold(0.0_f64, |a, b| a.max(*b)) as f32;
    levels.clear();
    levels.extend(ridge.iter().map(|light| light * strongest));
    of_levels(section, BRIGHTER_ON_LINE, levels)
}

/// From the brightest channel of pixels all over the picture.
pub(super) fn of_picture(
    section: &OpticsSection,
    stage: &Stage,
    lighting: &Lighting,
    seen: &VisibilityBuffer,
    patches: &mut Patches,
    levels: &mut Vec<f32>,
) -> f32 {
    levels.clear();
    for row in (METERED_EVERY / 2..seen.height).step_by(METERED_EVERY) {
        for column in (METERED_EVERY / 2..seen.width).step_by(METERED_EVERY) {
            let light = patches.shade_pixel(column, row, stage, lighting, seen);
            levels.push(light.into_iter().fold(0.0, f32::max));
        }
    }
    of_levels(section, BRIGHTER, levels)
}

fn of_levels(section: &OpticsSection, brighter: f32, levels: &mut [f32]) -> f32 {
    let [lowest, highest, target] =
        [section.gain.lowest, section.gain.highest, section.gain.target].map(|value| value as f32);
    if !section.gain.automatic {
        return lowest;
    }
    if levels.is_empty() {
        return highest;
    }
    let place = (((1.0 - brighter) * levels.len() as f32) as usize).min(levels.len() - 1);
    let (_, level, _) = levels.select_nth_unstable_by(place, f32::total_cmp);
    (target / level.max(f32::MIN_POSITIVE)).clamp(lowest, highest)
}
