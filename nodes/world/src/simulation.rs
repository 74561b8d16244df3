//! `[simulation]` of a rig file: what only the simulator needs to know of a handset.

use crate::TrackerSection;
use crate::optics::OpticsSection;
use geometry::{METRES_PER_MM, Rig};
use nalgebra::{Isometry3, Vector3};
use serde::Deserialize;

/// `[simulation]`: each section has documented defaults.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Simulation {
    /// `[simulation.optics]`: light, lens and sensor.
    pub optics: OpticsSection,
    /// `[simulation.tracker]`: errors of the pose tracker.
    pub tracker: TrackerSection,
    /// `[simulation.hand_eye_error]`: how wrong the rig file's `[body_from_camera]` is.
    pub hand_eye_error: HandEyeError,
}

/// What a calibration got wrong: where the camera truly is, seen from where the rig file has it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HandEyeError {
    /// Along the camera's axes.
    pub translation_mm: [f64; 3],
    /// About the camera's axes: one rotation about the vector, as large as it is long.
    pub rotation_deg: [f64; 3],
}

impl HandEyeError {
    /// said_camera_from_true_camera.
    pub fn said_from_true(&self) -> Isometry3<f64> {
        let metres = Vector3::from(self.translation_mm) * METRES_PER_MM;
        let radians = Vector3::from(self.rotation_deg).map(f64::to_radians);
        Isometry3::new(metres, radians)
    }

    fn check(&self) -> Result<(), SimulationError> {
        let limits = [("translation_mm", &self.translation_mm, 100.0), ("rotation_deg", &self.rotation_deg, 30.0)];
        for (key, values, most) in limits {
            if let Some(&value) = values.iter().find(|value| !(-most..=most).contains(*value)) {
                return Err(SimulationError::HandEye { key, value, most });
            }
        }
        Ok(())
    }
}

/// A section that cannot be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// An unknown key or a value of the wrong kind.
    #[error("[simulation] {0}")]
    Parse(String),
    /// A number that cannot be.
    #[error("[simulation.tracker] {key} = {value}: {wanted}")]
    Tracker {
        /// The key.
        key: &'static str,
        /// What it holds.
        value: f64,
        /// What it should hold.
        wanted: &'static str,
    },
    /// A calibration that cannot be so wrong.
    #[error("[simulation.hand_eye_error] {key}: {value} is more than {most} either way")]
    HandEye {
        /// The key.
        key: &'static str,
        /// What it holds.
        value: f64,
        /// The limit.
        most: f64,
    },
}

impl Simulation {
    /// Reads and checks the section of a rig; a rig without it has the defaults.
    pub fn from_rig(rig: &Rig) -> Result<Self, SimulationError> {
        let simulation: Self = match &rig.simulation {
            None => Self::default(),
            Some(table) => {
                table.clone().try_into().map_err(|e: toml::de::Error| SimulationError::Parse(e.to_string()))?
            }
        };
        simulation.tracker.check()?;
        simulation.hand_eye_error.check()?;
        Ok(simulation)
    }
}
