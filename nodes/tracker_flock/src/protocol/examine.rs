//! What a unit says of itself (EXAMINE; manual, chapter 7). Answers are raw bytes, low byte first, and may have any bit
//! set: the stream must stand still and be drained before.

use super::address::Addressing;
use super::errors::DeviceError;

/// What can be asked and is of use here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// The status word.
    Status,
    /// Its program's revision.
    Revision,
    /// Its crystal, in MHz.
    Crystal,
    /// 0: 36 inches, 1: 72.
    Scale,
    /// Filters that are off.
    Filters,
    /// Measurements a second, times 256.
    Rate,
    /// The last error; asking clears it.
    Error,
    /// Ten letters.
    Model,
    /// The last error with detail; asking clears it.
    ErrorDetail,
    /// How units are addressed.
    Addressing,
    /// Of the mains, in Hz.
    LineFrequency,
    /// Its address.
    Address,
    /// Axis and sign.
    Hemisphere,
    /// Whether all units answer together.
    GroupMode,
    /// A byte for each address.
    FlockStatus,
}

impl Parameter {
    /// Its number.
    pub fn number(self) -> u8 {
        match self {
            Self::Status => 0,
            Self::Revision => 1,
            Self::Crystal => 2,
            Self::Scale => 3,
            Self::Filters => 4,
            Self::Rate => 7,
            Self::Error => 10,
            Self::Model => 15,
            Self::ErrorDetail => 16,
            Self::Addressing => 19,
            Self::LineFrequency => 20,
            Self::Address => 21,
            Self::Hemisphere => 22,
            Self::GroupMode => 35,
            Self::FlockStatus => 36,
        }
    }

    /// How many bytes answer.
    pub fn answer_bytes(self, addressing: Addressing) -> usize {
        match self {
            Self::Error | Self::Addressing | Self::LineFrequency | Self::Address | Self::GroupMode => 1,
            Self::Model => 10,
            Self::FlockStatus => usize::from(addressing.most()),
            _ => 2,
        }
    }

    /// The question.
    pub fn question(self) -> [u8; 2] {
        [b'O', self.number()]
    }
}

/// The status word (parameter 0).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Status(pub u16);

impl Status {
    /// From its two bytes.
    pub fn of(bytes: [u8; 2]) -> Self {
        Self(u16::from_le_bytes(bytes))
    }
    fn bit(self, bit: u32) -> bool {
        self.0 >> bit & 1 == 1
    }
    /// This unit is the master.
    pub fn is_master(self) -> bool {
        self.bit(15)
    }
    /// The flock has been configured.
    pub fn is_configured(self) -> bool {
        self.bit(14)
    }
    /// There is an error to be asked for.
    pub fn has_error(self) -> bool {
        self.bit(13)
    }
    /// It measures.
    pub fn runs(self) -> bool {
        self.bit(12)
    }
    /// It was put to sleep.
    pub fn sleeps(self) -> bool {
        self.bit(5)
    }
    /// Output is held by XOFF.
    pub fn is_held(self) -> bool {
        self.bit(6)
    }
    /// The number of the format (`Format::status_code`).
    pub fn format_code(self) -> u8 {
        (self.0 >> 1 & 0xF) as u8
    }
    /// It streams.
    pub fn streams(self) -> bool {
        self.bit(0)
    }
}

/// One byte of the flock's status (parameter 36).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UnitStatus(pub u8);

impl UnitStatus {
    /// It answers on the FBB.
    pub fn is_accessible(self) -> bool {
        self.0 & 0x80 != 0
    }
    /// It measures.
    pub fn runs(self) -> bool {
        self.0 & 0x40 != 0
    }
    /// It has a sensor.
    pub fn has_sensor(self) -> bool {
        self.0 & 0x20 != 0
    }
    /// It has an extended range transmitter.
    pub fn has_extended_range(self) -> bool {
        self.0 & 0x10 != 0
    }
}

/// Revision as it is printed: integer part in the low byte, fraction in the high.
pub fn revision(bytes: [u8; 2]) -> String {
    format!("{}.{:02}", bytes[0], bytes[1])
}

/// Measurements a second (parameter 7).
pub fn rate_hz(bytes: [u8; 2]) -> f64 {
    f64::from(u16::from_le_bytes(bytes)) / 256.0
}

/// The model's name, without what pads it (spaces, or zeros: the manual does not say).
pub fn model(bytes: &[u8]) -> String {
    let letters = bytes.iter().filter(|byte| byte.is_ascii_graphic() || **byte == b' ');
    letters.map(|&byte| char::from(byte)).collect::<String>().trim().to_owned()
}

/// The error with its detail (parameter 16).
pub fn error(bytes: [u8; 2]) -> DeviceError {
    DeviceError { code: bytes[0], detail: bytes[1] }
}
