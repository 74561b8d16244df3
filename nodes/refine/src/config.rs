//! What the refinement assumes and how far it goes.

use serde::{Deserialize, Serialize};

/// Millimetres, milliseconds and degrees, because people write them. The defaults hold for every tracker of
/// config/rigs; sigmas are one standard deviation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Knots of the correction by the hand's tremor. Above 33 ms a part of it (8-12 Hz) stays in the result.
    pub knot_ms: f64,
    /// How far a hand trembles, along one axis.
    pub tremor_mm: f64,
    /// The same about one axis.
    pub tremor_deg: f64,
    /// Knots of the correction by what smoothing left of the tracker's noise.
    pub noise_knot_ms: f64,
    /// Knots of the slow correction, for what the tracker gets wrong for longer than its noise lasts.
    pub bias_knot_ms: f64,
    /// Size of the slow correction of the position.
    pub bias_position_mm: f64,
    /// Size of the slow correction of the rotation.
    pub bias_rotation_deg: f64,
    /// Size of each coefficient of the field, a polynomial in space, for the position.
    pub field_position_mm: f64,
    /// The same for the rotation.
    pub field_rotation_deg: f64,
    /// How well the camera's place on the handset is known.
    pub hand_eye_mm: f64,
    /// How well its orientation on the handset is known.
    pub hand_eye_deg: f64,
    /// How well the rig's pose offset is known.
    pub clock_ms: f64,
    /// How well it is known by how much a reading's orientation is older than its position (beyond what the tracker's node
    /// says, `rotation_lag_nanos`); 0 takes it as known. Ask for it when the tracker filters orientations by itself.
    pub rotation_lag_ms: f64,
    /// How smooth a hand's movement is, but for its tremor: a share of the penalty by which the tracker was smoothed.
    pub smoothness: f64,
    /// Where most of what stands on nothing else is one plane, it is a table, and flat when stripes are straight on it: all
    /// strokes that saw it agree by it. False when what the thing stands on is only nearly flat.
    pub flat_table: bool,
    /// Frames whose residual stays above so many medians are left out.
    pub most_residual: f64,
    /// Which points, which seeds: the same seed gives the same bytes.
    pub seed: u64,
    /// Readings further apart than this are a gap: frames in it have no pose.
    pub most_gap_ms: f64,
    /// Readings of degraded quality are used as well.
    pub use_degraded: bool,
    /// While the scan goes on it is refined again after so long; 0 refines only at its end.
    pub live_every_s: f64,
    /// A live revision brings about so many points at most; the final one has all.
    pub live_points: usize,
    /// A live revision brings a frame again when a point of it has moved by more than this since the frame was sent.
    pub live_moved_mm: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            knot_ms: 33.0,
            tremor_mm: 0.5,
            tremor_deg: 0.4,
            noise_knot_ms: 100.0,
            bias_knot_ms: 400.0,
            bias_position_mm: 1.0,
            bias_rotation_deg: 0.75,
            field_position_mm: 2.0,
            field_rotation_deg: 2.0,
            hand_eye_mm: 1.5,
            hand_eye_deg: 1.5,
            clock_ms: 20.0,
            rotation_lag_ms: 0.0,
            smoothness: 1.0,
            flat_table: true,
            most_residual: 3.0,
            seed: 1,
            most_gap_ms: 100.0,
            use_degraded: true,
            live_every_s: 1.0,
            live_points: 100_000,
            live_moved_mm: 0.5,
        }
    }
}

/// A number that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("refine: {key} = {value}: {wanted}")]
pub struct ConfigError {
    /// The key.
    pub key: &'static str,
    /// What it holds.
    pub value: f64,
    /// What it should hold.
    pub wanted: &'static str,
}

impl Config {
    /// Refuses what makes no sense.
    pub fn check(&self) -> Result<(), ConfigError> {
        let limits = [
            ("knot_ms", self.knot_ms, 5.0..=1000.0, "5 to 1000 ms"),
            ("tremor_mm", self.tremor_mm, 0.001..=100.0, "0.001 to 100 mm"),
            ("tremor_deg", self.tremor_deg, 0.001..=30.0, "0.001 to 30 degrees"),
            ("noise_knot_ms", self.noise_knot_ms, 5.0..=1000.0, "5 to 1000 ms"),
            ("bias_knot_ms", self.bias_knot_ms, 50.0..=60_000.0, "50 ms to 60 s"),
            ("bias_position_mm", self.bias_position_mm, 0.01..=100.0, "0.01 to 100 mm"),
            ("bias_rotation_deg", self.bias_rotation_deg, 0.01..=30.0, "0.01 to 30 degrees"),
            ("field_position_mm", self.field_position_mm, 0.01..=100.0, "0.01 to 100 mm"),
            ("field_rotation_deg", self.field_rotation_deg, 0.01..=30.0, "0.01 to 30 degrees"),
            ("hand_eye_mm", self.hand_eye_mm, 0.01..=100.0, "0.01 to 100 mm"),
            ("hand_eye_deg", self.hand_eye_deg, 0.01..=30.0, "0.01 to 30 degrees"),
            ("clock_ms", self.clock_ms, 0.01..=100.0, "0.01 to 100 ms"),
            ("rotation_lag_ms", self.rotation_lag_ms, 0.0..=100.0, "0 to 100 ms"),
            ("smoothness", self.smoothness, 1e-9..=1e3, "1e-9 to 1000"),
            ("most_residual", self.most_residual, 1.5..=100.0, "1.5 to 100 medians"),
            ("live_every_s", self.live_every_s, 0.0..=3600.0, "0 to 3600 s"),
            ("live_points", self.live_points as f64, 1e3..=1e9, "1000 to 1000000000"),
            ("live_moved_mm", self.live_moved_mm, 0.0..=100.0, "0 to 100 mm"),
            ("most_gap_ms", self.most_gap_ms, 1.0..=1e6, "1 ms to 1000 s"),
        ];
        match limits.into_iter().find(|(_, value, range, _)| !range.contains(value)) {
            None => Ok(()),
            Some((key, value, _, wanted)) => Err(ConfigError { key, value, wanted }),
        }
    }
}
