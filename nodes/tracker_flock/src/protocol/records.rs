//! Data records: words without their two low bits, the first byte marked by its phase bit (manual, pages 39-41).

use serde::{Deserialize, Serialize};

/// The most words that a record has.
pub const MOST_WORDS: usize = 12;
/// The most bytes: twelve words, button, metal, address.
pub const MOST_BYTES: usize = 2 * MOST_WORDS + 3;
/// The bit that marks the first byte of a record, and no other.
pub const PHASE: u8 = 0x80;

/// What a record holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Format {
    /// x, y, z.
    Position,
    /// Azimuth, elevation, roll.
    Angles,
    /// The nine words of the rotation.
    Matrix,
    /// Position and angles: the default after power-up.
    PositionAngles,
    /// Position and matrix: the only one whose sense nobody has ever doubted.
    PositionMatrix,
    /// w, x, y, z.
    Quaternion,
    /// Position and quaternion.
    PositionQuaternion,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Position,
        Self::Angles,
        Self::Matrix,
        Self::PositionAngles,
        Self::PositionMatrix,
        Self::Quaternion,
        Self::PositionQuaternion,
    ];

    /// How many words.
    pub fn words(self) -> usize {
        match self {
            Self::Position | Self::Angles => 3,
            Self::Matrix => 9,
            Self::PositionAngles => 6,
            Self::PositionMatrix => 12,
            Self::Quaternion => 4,
            Self::PositionQuaternion => 7,
        }
    }

    /// The command that chooses it.
    pub fn command(self) -> u8 {
        match self {
            Self::Position => b'V',
            Self::Angles => b'W',
            Self::Matrix => b'X',
            Self::PositionAngles => b'Y',
            Self::PositionMatrix => b'Z',
            Self::Quaternion => b'\\',
            Self::PositionQuaternion => b']',
        }
    }

    /// Its number in the status word (parameter 0, bits 4 to 1).
    pub fn status_code(self) -> u8 {
        match self {
            Self::Position => 1,
            Self::Angles => 2,
            Self::Matrix => 3,
            Self::PositionAngles => 4,
            Self::PositionMatrix => 5,
            Self::Quaternion => 7,
            Self::PositionQuaternion => 8,
        }
    }

    /// Whether its first three words are a position.
    pub fn has_position(self) -> bool {
        matches!(self, Self::Position | Self::PositionAngles | Self::PositionMatrix | Self::PositionQuaternion)
    }

    /// Whether it holds a quaternion.
    pub fn has_quaternion(self) -> bool {
        matches!(self, Self::Quaternion | Self::PositionQuaternion)
    }
}

/// How records look on the wire: all units of a flock are set to the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// The words.
    pub format: Format,
    /// A byte for the button follows.
    pub button: bool,
    /// A byte for the metal follows.
    pub metal: bool,
    /// A byte with the unit's address follows: group mode.
    pub group: bool,
}

impl Layout {
    /// Words only: a bird alone.
    pub fn plain(format: Format) -> Self {
        Self { format, button: false, metal: false, group: false }
    }

    /// How many bytes.
    pub fn bytes(&self) -> usize {
        2 * self.format.words() + usize::from(self.button) + usize::from(self.metal) + usize::from(self.group)
    }
}

/// A record as it came. What the layout does not have is 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Record {
    /// What the words mean.
    pub format: Format,
    /// The words; as many as the format has, then zeros.
    pub words: [i16; MOST_WORDS],
    /// 0x00 none, 0x10 left, 0x30 middle, 0x70 right.
    pub button: u8,
    /// 0 to 127.
    pub metal: u8,
    /// Which unit; 0 without group mode.
    pub address: u8,
}

impl Record {
    /// The words that the format has.
    pub fn used_words(&self) -> &[i16] {
        &self.words[..self.format.words()]
    }
}

/// Two bytes of a word, low one first; both without their highest bit, which is the phase's.
pub fn encode_word(word: i16) -> [u8; 2] {
    let shifted = (word as u16) >> 1;
    [((shifted & 0xFF) >> 1) as u8, (shifted >> 8) as u8]
}

/// The word of two bytes, without its two low bits. Phase bits are ignored.
pub fn decode_word(low: u8, high: u8) -> i16 {
    let shifted = (u16::from(high & !PHASE) << 8) | (u16::from(low & !PHASE) << 1);
    (shifted << 1) as i16
}

/// The bytes of a record: for emulators and tests.
pub fn encode(record: &Record, layout: &Layout) -> Vec<u8> {
    let mut bytes: Vec<u8> = record.used_words().iter().flat_map(|&word| encode_word(word)).collect();
    if let Some(first) = bytes.first_mut() {
        *first |= PHASE;
    }
    bytes.extend(layout.button.then_some(record.button));
    bytes.extend(layout.metal.then_some(record.metal & !PHASE));
    bytes.extend(layout.group.then_some(record.address));
    bytes
}

/// The record of exactly the bytes of a layout.
pub(crate) fn decode(bytes: &[u8], layout: &Layout) -> Record {
    let mut words = [0; MOST_WORDS];
    let (pairs, mut rest) = bytes.split_at((2 * layout.format.words()).min(bytes.len()));
    for (word, pair) in words.iter_mut().zip(pairs.chunks_exact(2)) {
        *word = decode_word(pair[0], pair[1]);
    }
    let mut next = |has: bool| match rest.split_first() {
        Some((&byte, behind)) if has => {
            rest = behind;
            byte
        }
        _ => 0,
    };
    let (button, metal, address) = (next(layout.button), next(layout.metal), next(layout.group));
    Record { format: layout.format, words, button, metal, address }
}
