//! Binary records: a header, and fields in the order of the output list.

use serde::{Deserialize, Serialize};

/// No record is longer.
pub const MOST_BYTES: usize = 128;
/// Nothing of a Polhemus is farther away, in inches: what says so is a bit error.
const MOST_INCHES: f32 = 1000.0;

/// Which device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// Four stations, 120 records a second among them, no clock.
    Fastrak,
    /// Up to sixteen stations, 240 a second each, with a clock.
    #[default]
    Liberty,
    /// Two stations, 60 a second each, with a clock.
    Patriot,
}

impl Family {
    /// How many stations it has at most.
    pub fn most_stations(self) -> u8 {
        match self {
            Self::Fastrak => 4,
            Self::Liberty => 16,
            Self::Patriot => 2,
        }
    }

    /// Whether it sends the time of its own clock.
    pub fn has_clock(self) -> bool {
        self != Self::Fastrak
    }

    /// The bytes of a record before its fields.
    pub fn header_bytes(self) -> usize {
        if self == Self::Fastrak { 3 } else { 8 }
    }

    /// With what each record begins.
    pub fn tag(self) -> &'static [u8] {
        match self {
            Self::Fastrak => b"0",
            Self::Liberty => b"LY",
            Self::Patriot => b"PA",
        }
    }
}

/// A field of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    /// A space: by it one sees that a record is whole.
    Space,
    /// CR and LF: the same, and surer.
    CrLf,
    /// x, y, z in inches: three 32-bit floats.
    Position,
    /// The same under the number that stands for more digits in text.
    PositionPrecise,
    /// Azimuth, elevation, roll in degrees.
    Euler,
    /// w, x, y, z.
    Quaternion,
    /// Milliseconds of the device's clock, 32 bits.
    TimeStamp,
    /// Frames since it was switched on, 32 bits.
    FrameCount,
    /// The stylus's switch.
    Stylus,
    /// How much the field is bent: 32 bits, signed.
    Distortion,
}

impl Item {
    /// Its number in an output list; `None` when the device has no such field.
    pub fn code(self, family: Family) -> Option<u8> {
        let (fastrak, others) = match self {
            Self::Space => (Some(0), Some(0)),
            Self::CrLf => (Some(1), Some(1)),
            Self::Position => (Some(2), Some(2)),
            Self::PositionPrecise => (None, Some(3)),
            Self::Euler => (Some(4), Some(4)),
            Self::Quaternion => (Some(11), Some(7)),
            Self::TimeStamp => (None, Some(8)),
            Self::FrameCount => (None, Some(9)),
            Self::Stylus => (Some(16), Some(10)),
            Self::Distortion => (None, Some(11)),
        };
        if family == Family::Fastrak { fastrak } else { others }
    }

    /// How many bytes.
    pub fn bytes(self, family: Family) -> usize {
        match self {
            Self::Space => 1,
            Self::CrLf => 2,
            Self::Position | Self::PositionPrecise | Self::Euler => 12,
            Self::Quaternion => 16,
            Self::Stylus if family == Family::Fastrak => 2,
            Self::TimeStamp | Self::FrameCount | Self::Stylus | Self::Distortion => 4,
        }
    }
}

/// What a record holds, in which order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// The device.
    pub family: Family,
    /// The output list.
    pub items: Vec<Item>,
}

impl Layout {
    /// What this driver asks for: position and quaternion; time and distortion where there are any; an end to check.
    pub fn of(family: Family) -> Self {
        let items = match family {
            Family::Fastrak => vec![Item::Position, Item::Quaternion, Item::CrLf],
            // No more than is used: one station at 240 a second fills 115200 baud to 96 %.
            _ => vec![Item::Position, Item::Quaternion, Item::TimeStamp, Item::Distortion, Item::CrLf],
        };
        Self { family, items }
    }

    /// The bytes of the fields.
    pub fn payload_bytes(&self) -> usize {
        self.items.iter().map(|item| item.bytes(self.family)).sum()
    }

    /// The bytes of a record.
    pub fn bytes(&self) -> usize {
        self.family.header_bytes() + self.payload_bytes()
    }
}

/// A record as it came; what the list does not have is 0 (for the quaternion: no turn).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// From 1.
    pub station: u8,
    /// A space, or a letter that says what is wrong.
    pub error: u8,
    /// x, y, z.
    pub position_inches: [f32; 3],
    /// Azimuth, elevation, roll.
    pub euler_deg: [f32; 3],
    /// w, x, y, z.
    pub quaternion_wxyz: [f32; 4],
    /// Milliseconds.
    pub time_stamp_ms: u32,
    /// Frames.
    pub frame: u32,
    /// 0 is undisturbed.
    pub distortion: i32,
    /// The stylus's switch is pressed.
    pub pressed: bool,
}

impl Default for Record {
    fn default() -> Self {
        Self {
            station: 1,
            error: b' ',
            position_inches: [0.0; 3],
            euler_deg: [0.0; 3],
            quaternion_wxyz: [1.0, 0.0, 0.0, 0.0],
            time_stamp_ms: 0,
            frame: 0,
            distortion: 0,
            pressed: false,
        }
    }
}

/// The bytes of a record: for emulators and tests.
pub fn encode(record: &Record, layout: &Layout) -> Vec<u8> {
    let family = layout.family;
    let mut bytes = family.tag().to_vec();
    if family == Family::Fastrak {
        bytes.extend([b'0' + record.station, record.error]);
    } else {
        bytes.extend([record.station, b'C', record.error, 0]);
        bytes.extend((layout.payload_bytes() as u16).to_le_bytes());
    }
    let floats = |bytes: &mut Vec<u8>, values: &[f32]| bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    for item in &layout.items {
        match item {
            Item::Space => bytes.push(b' '),
            Item::CrLf => bytes.extend(b"\r\n"),
            Item::Position | Item::PositionPrecise => floats(&mut bytes, &record.position_inches),
            Item::Euler => floats(&mut bytes, &record.euler_deg),
            Item::Quaternion => floats(&mut bytes, &record.quaternion_wxyz),
            Item::TimeStamp => bytes.extend(record.time_stamp_ms.to_le_bytes()),
            Item::FrameCount => bytes.extend(record.frame.to_le_bytes()),
            Item::Distortion => bytes.extend(record.distortion.to_le_bytes()),
            Item::Stylus if family == Family::Fastrak => bytes.extend([b' ', b'0' + u8::from(record.pressed)]),
            Item::Stylus => bytes.extend(u32::from(record.pressed).to_le_bytes()),
        }
    }
    bytes
}

/// True when these bytes may be the beginning of a record.
pub(crate) fn begins(bytes: &[u8], layout: &Layout) -> bool {
    let family = layout.family;
    let at = |k: usize, fits: &dyn Fn(u8) -> bool| bytes.get(k).is_none_or(|&byte| fits(byte));
    let tag = family.tag().iter().enumerate().all(|(k, &letter)| at(k, &|byte| byte == letter));
    if family == Family::Fastrak {
        let station = |byte: u8| (b'1'..=b'4').contains(&byte);
        return tag && at(1, &station) && at(2, &|byte| byte == b' ' || byte.is_ascii_alphabetic());
    }
    let length = (layout.payload_bytes() as u16).to_le_bytes();
    let station = |byte: u8| (1..=family.most_stations()).contains(&byte);
    tag && at(2, &station)
        && at(3, &|byte| byte.is_ascii_graphic())
        && at(6, &|byte| byte == length[0])
        && at(7, &|byte| byte == length[1])
}

/// The record of exactly the bytes of a layout; `None` when it does not end as it should, or cannot be true.
pub(crate) fn decode(bytes: &[u8], layout: &Layout) -> Option<Record> {
    let family = layout.family;
    let (header, mut rest) = bytes.split_at_checked(family.header_bytes())?;
    let (station, error) =
        if family == Family::Fastrak { (header[1] - b'0', header[2]) } else { (header[2], header[4]) };
    let mut record = Record { station, error, ..Record::default() };
    for item in &layout.items {
        let (field, behind) = rest.split_at_checked(item.bytes(family))?;
        rest = behind;
        match item {
            Item::Space if field != b" " => return None,
            Item::CrLf if field != b"\r\n" => return None,
            Item::Space | Item::CrLf => {}
            Item::Position | Item::PositionPrecise => record.position_inches = floats(field),
            Item::Euler => record.euler_deg = floats(field),
            Item::Quaternion => record.quaternion_wxyz = floats(field),
            Item::TimeStamp => record.time_stamp_ms = u32::from_le_bytes(field.try_into().ok()?),
            Item::FrameCount => record.frame = u32::from_le_bytes(field.try_into().ok()?),
            Item::Distortion => record.distortion = i32::from_le_bytes(field.try_into().ok()?),
            Item::Stylus => record.pressed = field.iter().any(|byte| !matches!(byte, b' ' | b'0' | 0)),
        }
    }
    plausible(&record).then_some(record)
}

fn floats<const N: usize>(bytes: &[u8]) -> [f32; N] {
    std::array::from_fn(|k| f32::from_le_bytes([bytes[4 * k], bytes[4 * k + 1], bytes[4 * k + 2], bytes[4 * k + 3]]))
}

/// A space alone is a weak end: what lies between must make sense as well.
fn plausible(record: &Record) -> bool {
    let near = record.position_inches.iter().all(|inches| inches.abs() < MOST_INCHES);
    let turned = record.euler_deg.iter().all(|degrees| degrees.abs() <= 360.0);
    let length: f32 = record.quaternion_wxyz.iter().map(|part| part * part).sum();
    near && turned && (length - 1.0).abs() < 0.02
}
