//! `[simulation.tracker]` of a rig file.

use crate::SimulationError;
use serde::Deserialize;

/// The errors of a tracker, each a number. Noise and field are root mean square lengths of the error vector.
///
/// The defaults are an Ascension Flock of Birds: noise from the paper (section 3: 1-2 mm, 3 degrees), the field fitted to
/// real readings (see config/rigs/paper.toml), filter and latency from its manual.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrackerSection {
    /// Readings a second.
    pub rate_hz: f64,
    /// White noise of the position.
    pub position_noise_mm: f64,
    /// White noise of the rotation.
    pub rotation_noise_deg: f64,
    /// Coloured (Ornstein-Uhlenbeck) noise of the position, beside the white.
    pub drift_position_mm: f64,
    /// Coloured noise of the rotation.
    pub drift_rotation_deg: f64,
    /// Correlation time of the coloured noise.
    pub drift_time_s: f64,
    /// Distortion of the position by the metal of the room, 1 m from the base.
    pub field_position_mm: f64,
    /// Distortion of the rotation, 1 m from the base.
    pub field_rotation_deg: f64,
    /// How smooth the distortion is.
    pub field_wavelength_m: f64,
    /// The distortion grows with this power of the distance from the base.
    pub field_growth: f64,
    /// Where the base (the transmitter) stands in the world.
    pub base_m: [f64; 3],
    /// The position is a multiple of this.
    pub position_step_mm: f64,
    /// The rotation's three angles are multiples of this.
    pub rotation_step_deg: f64,
    /// Time constant of the filter while the handset rests.
    pub filter_rest_s: f64,
    /// Time constant of the filter while it moves fast; 0 is no filter.
    pub filter_moving_s: f64,
    /// Half-way between the two at this speed.
    pub filter_speed_mm_per_s: f64,
    /// A reading is this old when it gets its stamp.
    pub latency_s: f64,
    /// The tracker's clock minus the camera's.
    pub clock_offset_s: f64,
    /// How much a stamp wanders: one standard deviation.
    pub stamp_jitter_s: f64,
    /// Share of the readings that are lost.
    pub dropped: f64,
    /// How many are lost in a row, on average.
    pub dropped_in_a_row: f64,
}

impl Default for TrackerSection {
    fn default() -> Self {
        Self {
            rate_hz: 100.0,
            position_noise_mm: 1.5,
            rotation_noise_deg: 3.0,
            drift_position_mm: 0.0,
            drift_rotation_deg: 0.0,
            drift_time_s: 0.3,
            field_position_mm: 10.9,
            field_rotation_deg: 2.2,
            field_wavelength_m: 1.56,
            field_growth: 0.7,
            base_m: [-0.35, 0.1, 0.05],
            position_step_mm: 0.11,
            rotation_step_deg: 0.022,
            filter_rest_s: 0.05,
            filter_moving_s: 0.005,
            filter_speed_mm_per_s: 30.0,
            latency_s: 0.0075,
            clock_offset_s: 0.0043,
            stamp_jitter_s: 0.0002,
            dropped: 0.005,
            dropped_in_a_row: 2.0,
        }
    }
}

impl TrackerSection {
    /// Without any error: every reading is the truth at its stamp.
    pub fn perfect() -> Self {
        Self {
            position_noise_mm: 0.0,
            rotation_noise_deg: 0.0,
            field_position_mm: 0.0,
            field_rotation_deg: 0.0,
            position_step_mm: 0.0,
            rotation_step_deg: 0.0,
            filter_rest_s: 0.0,
            filter_moving_s: 0.0,
            latency_s: 0.0,
            clock_offset_s: 0.0,
            stamp_jitter_s: 0.0,
            dropped: 0.0,
            ..Self::default()
        }
    }

    /// Refuses a tracker that cannot be.
    pub fn check(&self) -> Result<(), SimulationError> {
        let limits = [
            ("rate_hz", self.rate_hz, 1.0..=2000.0, "1 to 2000 Hz"),
            ("position_noise_mm", self.position_noise_mm, 0.0..=100.0, "0 to 100 mm"),
            ("rotation_noise_deg", self.rotation_noise_deg, 0.0..=30.0, "0 to 30 degrees"),
            ("drift_position_mm", self.drift_position_mm, 0.0..=100.0, "0 to 100 mm"),
            ("drift_rotation_deg", self.drift_rotation_deg, 0.0..=30.0, "0 to 30 degrees"),
            ("drift_time_s", self.drift_time_s, 0.001..=10.0, "0.001 to 10 s"),
            ("field_position_mm", self.field_position_mm, 0.0..=200.0, "0 to 200 mm"),
            ("field_rotation_deg", self.field_rotation_deg, 0.0..=30.0, "0 to 30 degrees"),
            ("field_wavelength_m", self.field_wavelength_m, 0.05..=100.0, "0.05 to 100 m"),
            ("field_growth", self.field_growth, 0.0..=6.0, "a power of 0 to 6"),
            ("position_step_mm", self.position_step_mm, 0.0..=10.0, "0 to 10 mm"),
            ("rotation_step_deg", self.rotation_step_deg, 0.0..=10.0, "0 to 10 degrees"),
            ("filter_rest_s", self.filter_rest_s, 0.0..=1.0, "0 to 1 s"),
            ("filter_moving_s", self.filter_moving_s, 0.0..=1.0, "0 to 1 s"),
            ("filter_speed_mm_per_s", self.filter_speed_mm_per_s, 0.1..=10_000.0, "0.1 to 10000 mm/s"),
            ("latency_s", self.latency_s, 0.0..=1.0, "0 to 1 s"),
            ("clock_offset_s", self.clock_offset_s, -10.0..=10.0, "at most 10 s either way"),
            ("stamp_jitter_s", self.stamp_jitter_s, 0.0..=0.1, "0 to 0.1 s"),
            ("dropped", self.dropped, 0.0..=0.9, "a share of 0 to 0.9"),
            ("dropped_in_a_row", self.dropped_in_a_row, 1.0..=20.0, "1 to 20"),
        ];
        let bad = limits.into_iter().find(|(_, value, range, _)| !range.contains(value));
        if let Some((key, value, _, wanted)) = bad {
            return Err(SimulationError::Tracker { key, value, wanted });
        }
        match self.base_m.into_iter().find(|x| !(-100.0..=100.0).contains(x)) {
            Some(value) => Err(SimulationError::Tracker { key: "base_m", value, wanted: "-100 to 100 m" }),
            None => Ok(()),
        }
    }
}
