//! One bird of the flock: its settings, and what it measures.

use super::EmulatorConfig;
use super::kept::Kept;
use super::metal::Metal;
use crate::protocol::reading::{Scale, words_of};
use crate::protocol::records::{Format, Layout, MOST_WORDS, Record};
use nalgebra::{UnitQuaternion, Vector3};

/// As it is after power-up.
pub(super) struct Unit {
    pub address: u8,
    pub format: Format,
    pub filters_off: u16,
    pub hemisphere: [u8; 2],
    pub mains_hz: u8,
    pub asleep: bool,
    scale: Scale,
    button: bool,
    metal: Metal,
    /// Metres, in the sensor's frame: what is reported instead of the sensor's own middle.
    offset_m: Vector3<f64>,
    /// Turns the sensor's frame, so that what was boresighted reads as no turn.
    boresight: UnitQuaternion<f64>,
    kept: Kept,
    alpha_min: [u16; 7],
    motion: [u16; 7],
    alpha_max: [u16; 7],
    lock: u8,
    measured: Option<(Vector3<f64>, UnitQuaternion<f64>)>,
}

/// Where the filter's ranges end, in inches.
const RANGE_INCHES: [f64; 6] = [17.0, 22.0, 27.0, 34.0, 42.0, 54.0];

impl Unit {
    pub fn new(address: u8) -> Self {
        Self {
            address,
            format: Format::PositionAngles,
            filters_off: 4,
            hemisphere: [0, 0],
            mains_hz: 60,
            asleep: false,
            scale: Scale::Inches36,
            button: false,
            metal: Metal::OFF,
            offset_m: Vector3::zeros(),
            boresight: UnitQuaternion::identity(),
            kept: Kept::new(),
            alpha_min: [0x028F; 7],
            motion: [2, 4, 8, 32, 64, 256, 512],
            alpha_max: [0x7333; 7],
            lock: 0,
            measured: None,
        }
    }

    /// Obeys a command for this unit; whether it ends the stream. An error when there is no such command.
    pub fn set(&mut self, code: u8, data: &[u8]) -> Result<bool, ()> {
        if let Some(&format) = Format::ALL.iter().find(|format| format.command() == code) {
            self.format = format;
            return Ok(true);
        }
        match (code, data) {
            (b'F', _) => self.asleep = false,
            (b'G', _) => self.asleep = true,
            (b'L', &[axis, sign]) | (b'P', &[22, axis, sign]) => self.hemisphere = [axis, sign],
            (b'M', &[on]) => self.button = on != 0,
            (b's', &[flag, data]) => self.metal.command(flag, data)?,
            (b'P', [28, words @ ..]) => self.metal.change(words),
            (b'K', words) => self.offset_m = offset(words, self.scale),
            (b'u', _) => self.boresight = self.measured.map_or_else(UnitQuaternion::identity, |(_, at)| at.inverse()),
            (b'v', _) => self.boresight = UnitQuaternion::identity(),
            (b'q', angles) => self.kept.set(23, angles)?,
            (b'r', angles) => self.kept.set(24, angles)?,
            // Sines and cosines instead of angles, and the transmitter of another unit: heard, and not played.
            (b'J' | b'H' | b'0', _) => {}
            (b'P', &[3, scale, 0]) => self.scale = if scale == 0 { Scale::Inches36 } else { Scale::Inches72 },
            (b'P', &[4, low, high]) => self.filters_off = u16::from_le_bytes([low, high]),
            (b'P', &[14, lock]) => self.lock = lock,
            (b'P', &[20, mains_hz]) => self.mains_hz = mains_hz,
            (b'P', [parameter @ (5 | 12 | 13), table @ ..]) => {
                let table = std::array::from_fn(|k| u16::from_le_bytes([table[2 * k], table[2 * k + 1]]));
                match parameter {
                    5 => self.alpha_min = table,
                    12 => self.motion = table,
                    _ => self.alpha_max = table,
                }
            }
            (b'P', [parameter, value @ ..]) => self.kept.set(*parameter, value)?,
            _ => return Err(()),
        }
        Ok(false)
    }

    pub fn examine(&self, parameter: u8) -> Vec<u8> {
        let words = |table: &[u16; 7]| table.iter().flat_map(|word| word.to_le_bytes()).collect();
        match parameter {
            3 => vec![u8::from(self.scale == Scale::Inches72), 0],
            4 => self.filters_off.to_le_bytes().to_vec(),
            5 => words(&self.alpha_min),
            12 => words(&self.motion),
            13 => words(&self.alpha_max),
            14 => vec![self.lock],
            20 => vec![self.mains_hz],
            21 => vec![self.address],
            22 => self.hemisphere.to_vec(),
            // The serial numbers of the unit, its sensor and its transmitter.
            25..=27 => (u16::from(parameter) * 100 + u16::from(self.address)).to_le_bytes().to_vec(),
            28 => self.metal.bytes(),
            other => self.kept.get(other),
        }
    }

    /// How much older the filters against the mains make a measurement: even means of two and of six have their middle so
    /// many cycles back.
    pub fn mains_filter_cycles(&self) -> f64 {
        let is_on = |bit: u16| self.filters_off & bit == 0;
        (if is_on(0b100) { 0.5 } else { 0.0 }) + if is_on(0b010) { 2.5 } else { 0.0 }
    }

    /// One cycle: the adaptive DC filter follows with a gain that grows from ALPHA_MIN to ALPHA_MAX with the motion.
    pub fn measure(&mut self, position: Vector3<f64>, rotation: UnitQuaternion<f64>, filters: bool) {
        if self.asleep {
            return;
        }
        let filtered = match self.measured {
            Some((last, turned)) if filters && self.filters_off & 1 == 0 => {
                let inches = position.norm() / 0.0254;
                let range = RANGE_INCHES.iter().filter(|end| inches > **end).count();
                let step = (position - last).norm() / self.scale.full_m() * 32768.0;
                let motion = (step / f64::from(self.motion[range]) / 64.0).min(1.0);
                let [least, most] = [self.alpha_min, self.alpha_max].map(|table| f64::from(table[range]) / 32768.0);
                let gain = least + (most - least) * motion;
                (last + (position - last) * gain, turned.slerp(&rotation, gain))
            }
            _ => (position, rotation),
        };
        self.measured = Some(filtered);
    }

    /// What it sends; `flipped` as if it were in the other half of space.
    pub fn record(&self, config: &EmulatorConfig, group: bool, flipped: bool) -> (Record, Layout) {
        let layout = Layout { format: self.format, button: self.button, metal: self.metal.is_on(), group };
        let empty = Record { format: self.format, words: [0; MOST_WORDS], button: 0, metal: 0, address: 0 };
        let measured = self.measured.map(|(position, rotation)| {
            let position = position + rotation * self.offset_m;
            let position = reported(self.hemisphere, position) * if flipped { -1.0 } else { 1.0 };
            words_of(self.format, self.scale, config.quaternion, &position, &(rotation * self.boresight))
        });
        let record = measured.unwrap_or(empty);
        (Record { button: config.button, metal: config.metal, address: self.address, ..record }, layout)
    }
}

/// Three words in the scaling of positions.
fn offset(words: &[u8], scale: Scale) -> Vector3<f64> {
    let word = |k: usize| words.get(2 * k..2 * k + 2).map_or(0, |two| i16::from_le_bytes([two[0], two[1]]));
    Vector3::from_fn(|k, _| f64::from(word(k)) * scale.full_m() / 32768.0)
}

/// The position as a bird gives it that was told a half of space: axis and sign, as the manual has them. The driver has a
/// table of its own.
fn reported(half: [u8; 2], position: Vector3<f64>) -> Vector3<f64> {
    let along = match half {
        [0x06, 0] => position.y,
        [0x06, _] => -position.y,
        [0x0C, 0] => position.z,
        [0x0C, _] => -position.z,
        [_, 0] => position.x,
        [..] => -position.x,
    };
    if along < 0.0 { -position } else { position }
}
