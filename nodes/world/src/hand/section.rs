//! `[hand]` of a scene file.

use crate::SceneError;
use serde::Deserialize;

/// How a person would sweep over this scene. All spreads are one standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HandSection {
    /// From the camera to the surface, on average (paper, section 2.1: about 20 cm).
    pub stand_off_mm: f64,
    /// How far the stand-off wanders, below 0.5 Hz.
    pub stand_off_spread_mm: f64,
    /// How far the pace wanders, as a share of itself.
    pub pace_spread: f64,
    /// Slow sway of the handset (below 2 Hz): root mean square length.
    pub sway_mm: f64,
    /// Slow sway of the handset: root mean square angle.
    pub sway_deg: f64,
    /// Tremor at 8 to 12 Hz: root mean square length.
    pub tremor_mm: f64,
    /// Tremor at 8 to 12 Hz: root mean square angle.
    pub tremor_deg: f64,
    /// The hand hurries no more than this; in too short a time it leaves out the last strokes.
    pub speed_limit_mm_per_s: f64,
    /// Also over the top, with the stripe across that of the rounds. Without these nothing ties one round to the next.
    pub crossing_strokes: bool,
    /// The paper's two passes, first the shape, then the colour, each in half the time; else both in one.
    pub two_passes: bool,
}

impl Default for HandSection {
    fn default() -> Self {
        Self {
            stand_off_mm: 200.0,
            stand_off_spread_mm: 8.0,
            pace_spread: 0.15,
            sway_mm: 2.0,
            sway_deg: 1.0,
            tremor_mm: 0.3,
            tremor_deg: 0.2,
            speed_limit_mm_per_s: 220.0,
            crossing_strokes: true,
            two_passes: false,
        }
    }
}

impl HandSection {
    /// Refuses a hand that nobody has.
    pub fn check(&self) -> Result<(), SceneError> {
        let limits = [
            ("stand_off_mm", self.stand_off_mm, 80.0..=600.0, "80 to 600 mm"),
            ("stand_off_spread_mm", self.stand_off_spread_mm, 0.0..=30.0, "0 to 30 mm"),
            ("pace_spread", self.pace_spread, 0.0..=0.3, "0 to 0.3"),
            ("sway_mm", self.sway_mm, 0.0..=10.0, "0 to 10 mm"),
            ("sway_deg", self.sway_deg, 0.0..=5.0, "0 to 5 degrees"),
            ("tremor_mm", self.tremor_mm, 0.0..=5.0, "0 to 5 mm"),
            ("tremor_deg", self.tremor_deg, 0.0..=3.0, "0 to 3 degrees"),
            ("speed_limit_mm_per_s", self.speed_limit_mm_per_s, 10.0..=2000.0, "10 to 2000 mm/s"),
        ];
        match limits.into_iter().find(|(_, value, range, _)| !range.contains(value)) {
            None => Ok(()),
            Some((key, value, _, wanted)) => {
                Err(SceneError::Value { object: "hand".to_owned(), key, value: value.to_string(), wanted })
            }
        }
    }
}
