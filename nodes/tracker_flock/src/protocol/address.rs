//! Who is meant (the manual's RS232-TO-FBB).

use serde::{Deserialize, Serialize};

/// How many units a flock may have; set by the switches of the master.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Addressing {
    /// 1 to 14.
    #[default]
    Normal,
    /// 1 to 30.
    Expanded,
    /// 1 to 126.
    SuperExpanded,
}

impl Addressing {
    /// The highest address.
    pub fn most(self) -> u8 {
        match self {
            Self::Normal => 14,
            Self::Expanded => 30,
            Self::SuperExpanded => 126,
        }
    }

    /// As a launch file names it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Expanded => "expanded",
            Self::SuperExpanded => "super_expanded",
        }
    }

    /// As parameter 19 tells it.
    pub fn from_code(code: u8) -> Option<Self> {
        match code {
            0 => Some(Self::Normal),
            1 => Some(Self::Expanded),
            3 => Some(Self::SuperExpanded),
            _ => None,
        }
    }
}

/// A command for the unit with this address, sent to the master. Address 0 is a bird alone: no prefix.
pub fn addressed(address: u8, command: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(command.len() + 2);
    match address {
        0 => {}
        1..=15 => bytes.push(0xF0 + address),
        16..=30 => bytes.push(0xE0 + address - 16),
        _ => bytes.extend([0xA0, address]),
    }
    bytes.extend_from_slice(command);
    bytes
}
