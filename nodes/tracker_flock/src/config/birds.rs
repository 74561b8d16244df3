//! Which units there are, and how far they reach.

use super::Config;
use crate::protocol::reading::Scale;

impl Config {
    /// The addresses that are spoken to: 0 for a bird alone.
    pub fn addresses(&self) -> Vec<u8> {
        if self.sensors.is_empty() { vec![0] } else { self.sensors.clone() }
    }

    /// True when units answer together, each record with its address; false for a bird alone.
    pub fn is_group(&self) -> bool {
        !self.sensors.is_empty()
    }

    /// How many boxes the flock has; 0 for a bird alone.
    pub fn unit_count(&self) -> u8 {
        if self.units == 0 { self.highest() } else { self.units }
    }

    pub(super) fn highest(&self) -> u8 {
        self.sensors.last().copied().unwrap_or(0)
    }

    /// Data of parameter 3; none with the extended range transmitter.
    pub(crate) fn scale_code(&self) -> Option<u16> {
        match self.scale_inches {
            Scale::Inches36 => Some(0),
            Scale::Inches72 => Some(1),
            Scale::Inches144 => None,
        }
    }
}
