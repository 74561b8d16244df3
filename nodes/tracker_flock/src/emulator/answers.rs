//! What the flock does when it is told, and says when it is asked.

use super::commands::Command;
use super::mood::{Mood, SATURATED};
use super::unit::Unit;
use super::{CONFIGURING_NANOS, FlockEmulator};
use crate::protocol::address::Addressing;

impl FlockEmulator {
    pub(super) fn obey(&mut self, command: Command, now: i64) {
        let Command { address, code, data } = command;
        let Some(index) = self.units.iter().position(|unit| unit.address == address || address == 0) else {
            self.error = 13;
            return;
        };
        match (code, data.as_slice()) {
            (b'B', _) => {
                self.streaming = false;
                if self.configured {
                    self.report(address, now);
                }
            }
            (b'@', _) => self.streaming = true,
            (b'?', _) => self.streaming = false,
            (b'Q', _) => self.report_every = 1,
            (b'R', _) => self.report_every = 2,
            (b'S', _) => self.report_every = 8,
            (b'T', _) => self.report_every = 32,
            (0x11, _) => self.held = false,
            (0x13, _) => self.held = true,
            (b'O', &[parameter]) => {
                let answer = self.examine(index, parameter);
                self.speech.say(now, answer);
            }
            (b'P', &[7, low, high]) => {
                self.rate_hz = (f64::from(u16::from_le_bytes([low, high])) / 256.0).clamp(20.0, 144.0)
            }
            (b'P', &[35, on]) => self.group = on != 0,
            (b'P', &[50, units]) => {
                self.busy_until = now + CONFIGURING_NANOS;
                self.configured = usize::from(units) == self.units.len();
                self.error = if self.configured { 0 } else { 13 };
            }
            (code, data) => match self.units[index].set(code, data) {
                Ok(ends_stream) => self.streaming &= !ends_stream,
                Err(()) => self.error = 6,
            },
        }
    }

    fn examine(&mut self, index: usize, parameter: u8) -> Vec<u8> {
        let unit = &self.units[index];
        match parameter {
            0 => {
                let bits = [
                    (15, index == 0),
                    (14, self.configured),
                    (13, self.error != 0),
                    (12, self.configured),
                    (8, true),
                    (6, self.held),
                    (5, unit.asleep),
                    (0, self.streaming),
                ];
                let word = bits.iter().fold(0u16, |word, (bit, on)| word | u16::from(*on) << bit);
                (word | u16::from(unit.format.status_code()) << 1).to_le_bytes().to_vec()
            }
            1 => vec![3, 67],
            2 => vec![25, 0],
            7 => ((self.rate_hz * 256.0) as u16).to_le_bytes().to_vec(),
            10 if self.mood == Mood::Saturated => vec![SATURATED],
            10 => vec![std::mem::take(&mut self.error)],
            15 if !self.config.has_sensor(unit.address) => b"6DERC     ".to_vec(),
            15 => b"6DFOB     ".to_vec(),
            16 => vec![std::mem::take(&mut self.error), 2],
            19 => vec![match self.config.addressing {
                Addressing::Normal => 0,
                Addressing::Expanded => 1,
                Addressing::SuperExpanded => 3,
            }],
            35 => vec![u8::from(self.group)],
            36 => {
                // Accessible, running, with a sensor, with a transmitter.
                let of = |unit: &Unit| {
                    let sensor = self.config.has_sensor(unit.address);
                    0xC0 | u8::from(sensor) << 5 | u8::from(unit.address == 1)
                };
                let most = usize::from(self.config.addressing.most());
                (0..most).map(|k| self.units.get(k).map_or(0, of)).collect()
            }
            other => unit.examine(other),
        }
    }
}
