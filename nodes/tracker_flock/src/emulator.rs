//! A flock that is played, byte for byte: commands in, records and answers out, each with its time. No port and no clock
//! of its own; with the feature `serial` it sits behind a pseudo-terminal (`serial_line::Pty`).
//!
//! It does what the manual says: it needs an auto-configuration when it has an address, hears nothing while it carries
//! that out, answers for all units in group mode, lowest address first, and mirrors positions into the hemisphere that it
//! was told. A record leaves at the end of its cycle; position and orientation in it are older, by different times.

mod speech;
mod unit;

use crate::protocol::reading::QuaternionSense;
use crate::protocol::records::{MOST_BYTES, encode};
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::wire_nanos;
use speech::{Command, next_command};
use std::collections::VecDeque;
use unit::Unit;

/// The flock that is played.
#[derive(Debug, Clone, PartialEq)]
pub struct EmulatorConfig {
    /// How many units, each with a sensor, addresses from 1; 0: a bird alone.
    pub units: u8,
    /// Paces what it sends.
    pub baud: u32,
    /// Until the host changes it.
    pub rate_hz: f64,
    /// Which way its quaternions turn.
    pub quaternion: QuaternionSense,
    /// How old a position is when its record leaves.
    pub position_latency_nanos: i64,
    /// How old an orientation is when its record leaves.
    pub rotation_latency_nanos: i64,
    /// Filter as the bird does: steady at rest, and late in motion. Without: the truth.
    pub filters: bool,
    /// What the measure of metal says.
    pub metal: u8,
    /// The error that it reports when it is asked first.
    pub error: u8,
}

impl Default for EmulatorConfig {
    fn default() -> Self {
        Self {
            units: 0,
            baud: 115_200,
            rate_hz: 103.0,
            quaternion: QuaternionSense::AsMatrix,
            position_latency_nanos: 7_500_000,
            rotation_latency_nanos: 2_000_000,
            filters: false,
            metal: 3,
            error: 0,
        }
    }
}

/// Where the sensor of a unit is at a moment, in the frame of the transmitter.
pub type World = Box<dyn Fn(u8, i64) -> (Vector3<f64>, UnitQuaternion<f64>) + Send>;

/// What is wrong with it, for tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mood {
    /// Nothing.
    Well,
    /// It says nothing: standby, or a cable that is half open.
    Silent,
    /// Its switch 8 is on: it says OK, twice a second.
    Test,
    /// Its baud rate is another: nothing that it says is understood, nor what it hears.
    WrongBaud,
}

/// A flock of birds.
pub struct FlockEmulator {
    config: EmulatorConfig,
    world: World,
    mood: Mood,
    units: Vec<Unit>,
    heard: Vec<u8>,
    /// It carries out an auto-configuration, and hears nothing.
    busy_until: i64,
    configured: bool,
    group: bool,
    streaming: bool,
    held: bool,
    report_every: u64,
    rate_hz: f64,
    error: u8,
    cycle: u64,
    cycle_nanos: i64,
    saying: VecDeque<(i64, Vec<u8>)>,
    line_free_at: i64,
}

/// How long an auto-configuration takes; the manual bids to wait a little longer.
const CONFIGURING_NANOS: i64 = 500_000_000;

impl FlockEmulator {
    /// A flock that has just been switched on.
    pub fn new(config: EmulatorConfig, world: World) -> Self {
        let addresses = if config.units == 0 { 0..=0 } else { 1..=config.units };
        Self {
            units: addresses.map(Unit::new).collect(),
            configured: config.units == 0,
            rate_hz: config.rate_hz,
            error: config.error,
            config,
            world,
            mood: Mood::Well,
            heard: Vec::new(),
            busy_until: i64::MIN,
            group: false,
            streaming: false,
            held: false,
            report_every: 1,
            cycle: 0,
            cycle_nanos: i64::MIN,
            saying: VecDeque::new(),
            line_free_at: i64::MIN,
        }
    }

    /// Makes it ill, or well again.
    pub fn set_mood(&mut self, mood: Mood) {
        self.mood = mood;
    }

    /// The host has sent bytes.
    pub fn hear(&mut self, bytes: &[u8], now_nanos: i64) {
        if now_nanos < self.busy_until || self.mood != Mood::Well {
            return;
        }
        self.advance(now_nanos);
        self.heard.extend_from_slice(bytes);
        while let Some((command, used)) = next_command(&self.heard) {
            self.heard.drain(..used);
            self.obey(command, now_nanos);
        }
    }

    /// The next bytes that have left by now, and when the last of them did.
    pub fn speak(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)> {
        self.advance(now_nanos);
        if self.saying.front().is_some_and(|(left, _)| *left <= now_nanos) { self.saying.pop_front() } else { None }
    }

    /// The parameters as the host left them: address, format's number, filters, hemisphere, mains.
    pub fn settings(&self) -> Vec<(u8, u8, u16, [u8; 2], u8)> {
        let of =
            |unit: &Unit| (unit.address, unit.format.status_code(), unit.filters_off, unit.hemisphere, unit.mains_hz);
        self.units.iter().map(of).collect()
    }

    fn period_nanos(&self) -> i64 {
        (1e9 / self.rate_hz) as i64
    }

    /// Lets the cycles go by that have ended by now.
    fn advance(&mut self, now_nanos: i64) {
        if self.cycle_nanos == i64::MIN {
            self.cycle_nanos = now_nanos;
        }
        while self.cycle_nanos + self.period_nanos() <= now_nanos {
            self.cycle_nanos += self.period_nanos();
            self.cycle += 1;
            match self.mood {
                Mood::Silent => {}
                Mood::Test if self.cycle.is_multiple_of((self.rate_hz as u64 / 2).max(1)) => {
                    self.say(self.cycle_nanos, b"OK\r\n".to_vec());
                }
                Mood::Test => {}
                Mood::WrongBaud => self.say(self.cycle_nanos, vec![0x78, 0x00, 0x60, 0x1E, 0x06, 0x18]),
                Mood::Well => self.measure(),
            }
        }
    }

    fn measure(&mut self) {
        let at = self.cycle_nanos;
        for unit in &mut self.units {
            let (position, _) = (self.world)(unit.address, at - self.config.position_latency_nanos);
            let (_, rotation) = (self.world)(unit.address, at - self.config.rotation_latency_nanos);
            unit.measure(position, rotation, self.config.filters);
        }
        if self.streaming && !self.held && self.configured && self.cycle.is_multiple_of(self.report_every) {
            self.report(0, at);
        }
    }

    /// The records of one cycle: those of all units in group mode, else the one that was asked.
    fn report(&mut self, address: u8, at_nanos: i64) {
        let mut bytes = Vec::with_capacity(MOST_BYTES);
        for unit in &self.units {
            let meant = self.group || unit.address == address || (address == 0 && unit.address <= 1);
            if meant {
                let (record, layout) = unit.record(&self.config, self.group);
                bytes.push(encode(&record, &layout));
            }
        }
        for record in bytes {
            self.say(at_nanos, record);
        }
    }

    fn say(&mut self, from_nanos: i64, bytes: Vec<u8>) {
        self.line_free_at = self.line_free_at.max(from_nanos) + wire_nanos(bytes.len(), self.config.baud);
        self.saying.push_back((self.line_free_at, bytes));
    }
}

#[cfg(feature = "serial")]
impl serial_line::Emulated for FlockEmulator {
    fn hear(&mut self, bytes: &[u8], now_nanos: i64) {
        FlockEmulator::hear(self, bytes, now_nanos);
    }
    fn speak(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)> {
        FlockEmulator::speak(self, now_nanos)
    }
}

impl FlockEmulator {
    fn obey(&mut self, command: Command, now: i64) {
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
                self.say(now, answer);
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
            10 => vec![std::mem::take(&mut self.error)],
            15 => b"6DFOB     ".to_vec(),
            16 => vec![std::mem::take(&mut self.error), 2],
            19 => vec![0],
            35 => vec![u8::from(self.group)],
            36 => {
                let unit = |k: usize| if k < self.units.len() { 0xE0 | u8::from(k == 0) } else { 0 };
                (0..14).map(unit).collect()
            }
            other => unit.examine(other),
        }
    }
}
