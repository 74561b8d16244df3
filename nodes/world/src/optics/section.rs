//! `[simulation.optics]` of a rig file.

use serde::Deserialize;

/// Numbers of light, lens and sensor.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OpticsSection {}
