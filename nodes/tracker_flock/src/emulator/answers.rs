//! What the flock does when it is told, and says when it is asked.

use super::commands::Command;
use super::fault::Fault;
use super::mood::{Mood, SATURATED};
use super::unit::Unit;
use super::{CONFIGURING_NANOS, FlockEmulator};
use crate::protocol::address::Addressing;

const CRYSTAL_MHZ: u8 = 25;
/// A cycle takes so many counts of parameter 6 for each millisecond, four times over at eight ticks of the crystal each, and
/// a little beside.
const COUNTS_PER_MS: f64 = 1000.0 * CRYSTAL_MHZ as f64 / 32.0;
const OVERHEAD_MS: f64 = 0.3;
const SLOWEST_HZ: f64 = 20.0;
const FASTEST_HZ: f64 = 144.0;
/// SYNC 8: the host gives the beat.
const HOST_SYNC: u8 = 8;

impl FlockEmulator {
    pub(super) fn obey(&mut self, command: Command, now: i64) {
        let Command { address, code, data } = command;
        let Some(index) = self.units.iter().position(|unit| unit.address == address || address == 0) else {
            return self.fault.raise(13, address);
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
            (b'N', _) => self.speech.say(now, vec![self.config.button]),
            (b't', _) => self.speech.say(now, vec![self.config.metal]),
            // What the pick-up measures, and its period: there is no screen here.
            (b'A', &[255]) => self.speech.say(now, vec![0; 4]),
            (b'A', &[sync]) => self.sync = sync,
            (b'/', _) => self.restart_slaves(now),
            (b'P', change) => self.change(index, change, now),
            (code, data) => match self.units[index].set(code, data) {
                Ok(ends_stream) => self.streaming &= !ends_stream,
                Err(()) => self.fault.raise(6, 0),
            },
        }
    }

    /// CHANGE: what is the flock's own, and not one unit's.
    fn change(&mut self, index: usize, change: &[u8], now: i64) {
        match *change {
            [6, low, high] => {
                let hz = 1000.0 / (f64::from(u16::from_le_bytes([low, high])) / COUNTS_PER_MS + OVERHEAD_MS);
                self.rate_hz = hz.clamp(SLOWEST_HZ, FASTEST_HZ);
            }
            [7, low, high] => {
                self.rate_hz = (f64::from(u16::from_le_bytes([low, high])) / 256.0).clamp(SLOWEST_HZ, FASTEST_HZ);
            }
            [29, every @ 1..=127] => self.report_every = u64::from(every),
            [35, on] => self.group = on != 0,
            [50, units] => {
                self.busy_until = now + CONFIGURING_NANOS;
                self.configured = usize::from(units) == self.units.len();
                self.fault = Fault::new(0);
                if !self.configured {
                    self.fault.raise(13, units.min(self.units.len() as u8 + 1));
                }
            }
            _ => {
                if self.units[index].set(b'P', change).is_err() {
                    self.fault.raise(6, 0);
                }
            }
        }
    }

    fn examine(&mut self, index: usize, parameter: u8) -> Vec<u8> {
        if self.mood == Mood::Saturated && matches!(parameter, 10 | 16) {
            self.fault.raise(SATURATED, 0);
        }
        let unit = &self.units[index];
        match parameter {
            0 => self.status(index).to_le_bytes().to_vec(),
            1 => vec![3, 67],
            2 => vec![CRYSTAL_MHZ, 0],
            6 => (((1000.0 / self.rate_hz - OVERHEAD_MS) * COUNTS_PER_MS).round() as u16).to_le_bytes().to_vec(),
            7 => ((self.rate_hz * 256.0).round() as u16).to_le_bytes().to_vec(),
            10 => vec![self.fault.take()[0]],
            15 if !self.config.has_sensor(unit.address) => b"6DERC     ".to_vec(),
            15 => b"6DFOB     ".to_vec(),
            16 => self.fault.take().to_vec(),
            19 => vec![match self.config.addressing {
                Addressing::Normal => 0,
                Addressing::Expanded => 1,
                Addressing::SuperExpanded => 3,
            }],
            29 => vec![self.report_every as u8],
            35 => vec![u8::from(self.group)],
            36 => self.flock_status(),
            50 => self.configuration(),
            other => unit.examine(other),
        }
    }

    fn status(&mut self, index: usize) -> u16 {
        let unit = &self.units[index];
        let bits = [
            (15, index == 0),
            (14, self.configured),
            (13, self.fault.take_bit()),
            (12, self.configured),
            (11, self.sync == HOST_SYNC),
            (10, self.config.addressing != Addressing::Normal),
            (9, (1..=3).contains(&self.sync)),
            (8, self.sync == 0),
            (6, self.held),
            (5, unit.asleep),
            (0, self.streaming),
        ];
        let word = bits.iter().fold(0u16, |word, (bit, on)| word | u16::from(*on) << bit);
        word | u16::from(unit.format.status_code()) << 1
    }

    /// A byte for each address: accessible, running, with a sensor, with an extended range transmitter, with the first
    /// transmitter.
    fn flock_status(&self) -> Vec<u8> {
        let of = |unit: &Unit| {
            let sensor = self.config.has_sensor(unit.address);
            let bits = [(7, true), (6, self.configured), (5, sensor), (4, !sensor), (0, unit.address == 1)];
            bits.iter().fold(0, |byte, (bit, on)| byte | u8::from(*on) << bit)
        };
        let most = usize::from(self.config.addressing.most());
        (0..most).map(|k| self.units.get(k).map_or(0, of)).collect()
    }

    /// How it was configured: one byte, then a bit for each address that runs, and one for each that depends on another's
    /// transmitter. The notes give the lengths; that bit k stands for address k is from memory.
    fn configuration(&self) -> Vec<u8> {
        let bytes = match self.config.addressing {
            Addressing::Normal => 2,
            Addressing::Expanded => 3,
            Addressing::SuperExpanded => 9,
        };
        let bits = |first: u8| {
            let mut field = vec![0u8; bytes];
            for address in self.units.iter().map(|unit| unit.address).filter(|address| *address >= first) {
                if let Some(byte) = field.get_mut(usize::from(address / 8)).filter(|_| self.configured) {
                    *byte |= 1 << (address % 8);
                }
            }
            field
        };
        [vec![u8::from(self.configured)], bits(1), bits(2)].concat()
    }
}
