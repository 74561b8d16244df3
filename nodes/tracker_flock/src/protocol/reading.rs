//! What the words of a record mean (manual, pages 76-88 and 140).

use super::records::{Format, Record};
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// Words are fractions of this.
const ONE: f64 = 32768.0;
const INCH_M: f64 = 0.0254;
/// Words come without their two low bits: the largest that can come, and its negative, mean "as far as I can tell".
const LARGEST_WORD: i32 = 32764;
/// How far words may be from a rotation: they are coarse to 1.2e-4 each, and rounded.
const ROTATION_TOLERANCE: f64 = 0.01;

/// How far full scale is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub enum Scale {
    /// 36 inches.
    #[default]
    Inches36,
    /// 72 inches.
    Inches72,
    /// 144 inches: the extended range transmitter, which has no other.
    Inches144,
}

impl From<Scale> for u8 {
    fn from(scale: Scale) -> Self {
        match scale {
            Scale::Inches36 => 36,
            Scale::Inches72 => 72,
            Scale::Inches144 => 144,
        }
    }
}

impl TryFrom<u8> for Scale {
    type Error = String;
    fn try_from(inches: u8) -> Result<Self, String> {
        let all = [Self::Inches36, Self::Inches72, Self::Inches144];
        let found = all.into_iter().find(|scale| u8::from(*scale) == inches);
        found.ok_or_else(|| format!("{inches} inches: 36 or 72, or 144 with the extended range transmitter"))
    }
}

impl Scale {
    /// Full scale in metres.
    pub fn full_m(self) -> f64 {
        INCH_M * f64::from(u8::from(self))
    }
}

/// Which way the quaternion turns: the manual does not say whether it is that of its matrix or of the transposed one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum QuaternionSense {
    /// transmitter_from_sensor, as the matrix.
    #[default]
    AsMatrix,
    /// sensor_from_transmitter.
    Inverse,
}

/// What was measured, in the frame of the transmitter: x away from its cable, y to the right, z down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// In metres, when the format has a position.
    pub position_m: Option<Vector3<f64>>,
    /// transmitter_from_sensor, when the format has an orientation.
    pub rotation: Option<UnitQuaternion<f64>>,
}

/// Why words are no measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
pub enum NoReading {
    /// A bit error, or another format than was asked for.
    #[error("an orientation that is no rotation: bit errors, or a format that was not asked for")]
    NoRotation,
    /// It sticks at the end of its scale.
    #[error("the position is at the end of the scale: bring the sensor nearer, or choose a larger scale")]
    FullScale,
    /// All zeros.
    #[error("all zeros: the sensor is too near the transmitter, or it is not plugged in")]
    Zeros,
}

impl Reading {
    /// The measurement in a record.
    pub fn of(record: &Record, scale: Scale, sense: QuaternionSense) -> Result<Self, NoReading> {
        let words = record.used_words();
        if words.iter().all(|&word| word == 0) {
            return Err(NoReading::Zeros);
        }
        let (position, turn) = words.split_at(if record.format.has_position() { 3 } else { 0 });
        if position.iter().any(|&word| i32::from(word).abs() >= LARGEST_WORD) {
            return Err(NoReading::FullScale);
        }
        let metres = |word: i16| f64::from(word) / ONE * scale.full_m();
        let position_m = match position {
            &[x, y, z] => Some(Vector3::new(metres(x), metres(y), metres(z))),
            _ => None,
        };
        Ok(Self { position_m, rotation: rotation(record.format, turn, sense)? })
    }
}

fn rotation(format: Format, words: &[i16], sense: QuaternionSense) -> Result<Option<UnitQuaternion<f64>>, NoReading> {
    let part = |word: i16| f64::from(word) / ONE;
    match (format, words) {
        (Format::Angles | Format::PositionAngles, &[azimuth, elevation, roll]) => {
            let [azimuth, elevation, roll] = [azimuth, elevation, roll].map(|word| part(word) * std::f64::consts::PI);
            if elevation.abs() > std::f64::consts::FRAC_PI_2 + 1e-3 {
                return Err(NoReading::NoRotation);
            }
            Ok(Some(UnitQuaternion::from_euler_angles(roll, elevation, azimuth)))
        }
        (Format::Matrix | Format::PositionMatrix, words) => {
            // Sent column by column of the manual's M, which is sensor_from_transmitter (page 140, the stylus): read row
            // by row they are its transpose, transmitter_from_sensor.
            let m = Matrix3::from_row_iterator(words.iter().map(|&word| part(word)));
            let off = (m.transpose() * m - Matrix3::identity()).abs().max();
            if off > ROTATION_TOLERANCE || m.determinant() < 0.0 {
                return Err(NoReading::NoRotation);
            }
            Ok(Some(UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(m))))
        }
        (Format::Quaternion | Format::PositionQuaternion, &[w, x, y, z]) => {
            let q = Quaternion::new(part(w), part(x), part(y), part(z));
            if (q.norm() - 1.0).abs() > ROTATION_TOLERANCE {
                return Err(NoReading::NoRotation);
            }
            let q = UnitQuaternion::from_quaternion(q);
            Ok(Some(match sense {
                QuaternionSense::AsMatrix => q,
                QuaternionSense::Inverse => q.inverse(),
            }))
        }
        _ => Ok(None),
    }
}

/// Which way the quaternion turns, from the same still sensor read as matrix and as quaternion (`AsMatrix`); `None` when
/// it moved between the two, or stands so that both senses look alike (a turn by nearly 0 or 180 degrees).
pub fn settle_sense(matrix: &UnitQuaternion<f64>, quaternion: &UnitQuaternion<f64>) -> Option<QuaternionSense> {
    const SAME_RAD: f64 = 0.02;
    const APART_RAD: f64 = 0.1;
    let (as_matrix, inverse) = (matrix.angle_to(quaternion), matrix.angle_to(&quaternion.inverse()));
    match (as_matrix, inverse) {
        (same, other) if same < SAME_RAD && other > APART_RAD => Some(QuaternionSense::AsMatrix),
        (other, same) if same < SAME_RAD && other > APART_RAD => Some(QuaternionSense::Inverse),
        _ => None,
    }
}

/// The words of a pose as a bird sends it: for emulators and tests. Beyond its scale a position sticks at the end.
pub fn words_of(
    format: Format,
    scale: Scale,
    sense: QuaternionSense,
    position_m: &Vector3<f64>,
    rotation: &UnitQuaternion<f64>,
) -> Record {
    let word = |part: f64| (part * ONE).round().clamp(-ONE, ONE - 1.0) as i16;
    let mut words = [0; super::records::MOST_WORDS];
    let mut slots = words.iter_mut();
    let mut put = |part: f64| {
        if let Some(slot) = slots.next() {
            *slot = word(part);
        }
    };
    if format.has_position() {
        position_m.iter().for_each(|metres| put(metres / scale.full_m()));
    }
    match format {
        Format::Position => {}
        Format::Angles | Format::PositionAngles => {
            let (roll, elevation, azimuth) = rotation.euler_angles();
            [azimuth, elevation, roll].iter().for_each(|angle| put(angle / std::f64::consts::PI));
        }
        Format::Matrix | Format::PositionMatrix => {
            // Row by row: nalgebra keeps columns, so those of the transpose.
            rotation.to_rotation_matrix().matrix().transpose().iter().for_each(|&part| put(part));
        }
        Format::Quaternion | Format::PositionQuaternion => {
            let q = match sense {
                QuaternionSense::AsMatrix => *rotation,
                QuaternionSense::Inverse => rotation.inverse(),
            };
            [q.w, q.i, q.j, q.k].iter().for_each(|&part| put(part));
        }
    }
    Record { format, words, button: 0, metal: 0, address: 0 }
}
