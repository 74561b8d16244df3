//! `[simulation]` of a rig file: what only the simulator needs to know of a handset.

use crate::TrackerSection;
use crate::optics::OpticsSection;
use geometry::Rig;
use serde::Deserialize;

/// `[simulation]`: each section has documented defaults.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Simulation {
    /// `[simulation.optics]`: light, lens and sensor.
    pub optics: OpticsSection,
    /// `[simulation.tracker]`: errors of the pose tracker.
    pub tracker: TrackerSection,
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
        Ok(simulation)
    }
}
