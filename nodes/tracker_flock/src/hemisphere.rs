//! Which half of space a sensor is in.

use serde::{Deserialize, Serialize};

/// Half of the space around the transmitter: x away from its cable, y to the right, z down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hemisphere {
    /// +x.
    #[default]
    Forward,
    /// -x.
    Aft,
    /// -z.
    Upper,
    /// +z.
    Lower,
    /// -y.
    Left,
    /// +y.
    Right,
}

impl Hemisphere {
    /// Axis and sign as the commands have them.
    pub fn code(self) -> [u8; 2] {
        match self {
            Self::Forward => [0x00, 0],
            Self::Aft => [0x00, 1],
            Self::Upper => [0x0C, 1],
            Self::Lower => [0x0C, 0],
            Self::Left => [0x06, 1],
            Self::Right => [0x06, 0],
        }
    }
}
