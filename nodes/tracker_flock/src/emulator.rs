//! A flock that is played, byte for byte: commands in, records and answers out, each with its time. No port and no clock
//! of its own; `serial_line::Pty` puts it behind a pseudo-terminal.
//!
//! It does what the manual says: it needs an auto-configuration when it has an address, hears nothing while it carries
//! that out, answers for all units in group mode, lowest address first, and mirrors positions into the hemisphere that it
//! was told. A record leaves at the end of its cycle; position and orientation in it are older, by different times. Every
//! parameter is told and can be changed; those that its module `kept` lists have no effect, nor has a beat that the host gives (SYNC).

mod answers;
mod commands;
mod fault;
mod kept;
mod metal;
mod mood;
mod power;
mod unit;

use crate::protocol::address::Addressing;
use crate::protocol::reading::QuaternionSense;
use crate::protocol::records::encode;
use commands::next_command;
use fault::Fault;
pub use mood::{Mood, TestMode};
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{Emulated, Speech};
use unit::Unit;

/// The flock that is played.
#[derive(Debug, Clone, PartialEq)]
pub struct EmulatorConfig {
    /// How many units, addresses from 1; 0: a bird alone.
    pub units: u8,
    /// As the switches of the master have it.
    pub addressing: Addressing,
    /// The address of the first unit with a sensor: those before it are extended range controllers.
    pub first_sensor: u8,
    /// Paces what it sends.
    pub baud: u32,
    /// Until the host changes it.
    pub rate_hz: f64,
    /// Which way its quaternions turn.
    pub quaternion: QuaternionSense,
    /// How old a position is when its record leaves, when no filter against the mains is on.
    pub position_latency_nanos: i64,
    /// The same of an orientation.
    pub rotation_latency_nanos: i64,
    /// The adaptive filter, as the bird has it: steady at rest, and late in motion. Without: the truth.
    pub filters: bool,
    /// What the measure of metal says.
    pub metal: u8,
    /// What the byte of the button says: 0x00 none, 0x10 left, 0x30 middle, 0x70 right.
    pub button: u8,
    /// It changes its mind so often about the half of space that its sensors are in; 0 is never.
    pub flip_every_nanos: i64,
    /// The error that it reports when it is asked first.
    pub error: u8,
}

impl Default for EmulatorConfig {
    fn default() -> Self {
        Self {
            units: 0,
            addressing: Addressing::Normal,
            first_sensor: 1,
            baud: 115_200,
            rate_hz: 103.0,
            quaternion: QuaternionSense::AsMatrix,
            position_latency_nanos: 7_500_000,
            rotation_latency_nanos: 2_000_000,
            filters: false,
            metal: 3,
            button: 0,
            flip_every_nanos: 0,
            error: 0,
        }
    }
}

impl EmulatorConfig {
    /// Whether the unit with this address has a sensor.
    fn has_sensor(&self, address: u8) -> bool {
        self.units == 0 || address >= self.first_sensor
    }

    /// Whether it believes the wrong half of space at a moment.
    fn is_flipped(&self, nanos: i64) -> bool {
        self.flip_every_nanos > 0 && (nanos / self.flip_every_nanos) % 2 != 0
    }
}

/// Where the sensor of a unit is at a moment, in the frame of the transmitter.
pub type World = Box<dyn Fn(u8, i64) -> (Vector3<f64>, UnitQuaternion<f64>) + Send>;

/// A flock of birds.
pub struct FlockEmulator {
    config: EmulatorConfig,
    world: World,
    mood: Mood,
    units: Vec<Unit>,
    heard: Vec<u8>,
    /// It starts up or carries out an auto-configuration, and hears nothing.
    busy_until: i64,
    configured: bool,
    group: bool,
    streaming: bool,
    held: bool,
    /// RTS is high.
    standby: bool,
    report_every: u64,
    rate_hz: f64,
    fault: Fault,
    sync: u8,
    cycle: u64,
    cycle_nanos: i64,
    speech: Speech,
    /// What a test mode has counted to.
    counted: u8,
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
            fault: Fault::new(config.error),
            speech: Speech::new(config.baud),
            config,
            world,
            mood: Mood::Well,
            heard: Vec::new(),
            busy_until: i64::MIN,
            group: false,
            streaming: false,
            held: false,
            standby: false,
            report_every: 1,
            sync: 0,
            cycle: 0,
            cycle_nanos: i64::MIN,
            counted: 0,
        }
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
            if !self.standby && self.cycle_nanos >= self.busy_until {
                self.live(self.cycle_nanos);
            }
        }
    }

    fn measure(&mut self) {
        let (at, period) = (self.cycle_nanos, self.period_nanos());
        for unit in &mut self.units {
            let filtered = at - (unit.mains_filter_cycles() * period as f64) as i64;
            let (position, _) = (self.world)(unit.address, filtered - self.config.position_latency_nanos);
            let (_, rotation) = (self.world)(unit.address, filtered - self.config.rotation_latency_nanos);
            unit.measure(position, rotation, self.config.filters);
        }
        if self.streaming && !self.held && self.configured && self.cycle.is_multiple_of(self.report_every) {
            self.report(0, at);
        }
    }

    /// The records of one cycle: those of all units in group mode, else the one that was asked.
    fn report(&mut self, address: u8, at_nanos: i64) {
        let flipped = self.config.is_flipped(at_nanos);
        for unit in self.units.iter().filter(|unit| self.config.has_sensor(unit.address)) {
            let meant = self.group || unit.address == address || (address == 0 && unit.address <= 1);
            if meant {
                let (mut record, layout) = unit.record(&self.config, self.group, flipped);
                self.bend(&mut record);
                self.speech.say(at_nanos, encode(&record, &layout));
            }
        }
    }
}

impl Emulated for FlockEmulator {
    fn hear(&mut self, bytes: &[u8], now_nanos: i64) {
        if now_nanos < self.busy_until || self.standby || !self.understands(bytes, now_nanos) {
            return;
        }
        self.advance(now_nanos);
        self.heard.extend_from_slice(bytes);
        while let Some((command, used)) = next_command(&self.heard) {
            self.heard.drain(..used);
            self.obey(command, now_nanos);
        }
    }

    fn speak(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)> {
        self.advance(now_nanos);
        self.speech.leave(now_nanos)
    }
}
