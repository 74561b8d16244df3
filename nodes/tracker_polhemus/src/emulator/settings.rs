//! What the host has set, and what of it the device forgets when it starts up.

use super::EmulatorConfig;
use crate::protocol::records::{Item, Layout};
use nalgebra::Vector3;

/// Of the whole device, and of each station.
#[derive(Debug, Clone)]
pub(super) struct Settings {
    pub layouts: Vec<Layout>,
    pub active: Vec<bool>,
    /// None: the device follows by itself.
    pub hemispheres: Vec<Vector3<f64>>,
    pub binary: bool,
    pub centimetres: bool,
    pub continuous: bool,
}

impl Settings {
    /// As they are after power-up.
    pub fn power_up(config: &EmulatorConfig) -> Self {
        let layout = Layout { family: config.family, items: vec![Item::Position, Item::Euler, Item::CrLf] };
        let stations = usize::from(config.stations);
        Self {
            layouts: vec![layout; stations],
            active: vec![true; stations],
            hemispheres: vec![Vector3::x(); stations],
            binary: false,
            centimetres: false,
            continuous: false,
        }
    }
}
