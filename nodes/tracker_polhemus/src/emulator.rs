//! A Fastrak, Liberty or Patriot that is played, byte for byte: commands in, records and answers out, each with its time.
//! No port and no clock of its own; `serial_line::Pty` puts it behind a pseudo-terminal.

mod commands;
mod settings;

use crate::protocol::records::{Family, Record, encode};
use commands::next_command;
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{Emulated, Speech};
use settings::Settings;

const INCH_M: f64 = 0.0254;
const CENTIMETRE_M: f64 = 0.01;

/// The device that is played.
#[derive(Debug, Clone, PartialEq)]
pub struct EmulatorConfig {
    /// Which one.
    pub family: Family,
    /// How many stations have a sensor.
    pub stations: u8,
    /// Paces what it sends.
    pub baud: u32,
    /// Records a second from each station.
    pub rate_hz: f64,
    /// How old a pose is when its record leaves.
    pub latency_nanos: i64,
    /// How fast its clock runs: 1 is true.
    pub clock_rate: f64,
    /// What it says of the field.
    pub distortion: i32,
    /// What it says of each station: a space when all is well.
    pub error: u8,
    /// It changes its mind so often about the half of space that its sensors are in; 0 is never.
    pub flip_every_nanos: i64,
}

impl EmulatorConfig {
    /// A device of a family as its data sheet has it, with one sensor.
    pub fn of(family: Family) -> Self {
        let sheet = crate::Config { family, ..crate::Config::default() }.sheet();
        Self {
            family,
            stations: 1,
            baud: 115_200,
            rate_hz: sheet.rate_hz,
            latency_nanos: (sheet.latency_ms * 1e6) as i64,
            clock_rate: 1.0,
            distortion: 0,
            error: b' ',
            flip_every_nanos: 0,
        }
    }
}

/// Where the sensor of a station is at a moment, in the frame of the source.
pub type World = Box<dyn Fn(u8, i64) -> (Vector3<f64>, UnitQuaternion<f64>) + Send>;

/// What is wrong with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mood {
    /// Nothing.
    Well,
    /// It says nothing.
    Silent,
    /// Its baud rate is another: nothing that it says is understood, nor what it hears.
    WrongBaud,
}

/// From a Ctrl-Y until it hears again.
const START_UP_NANOS: i64 = 10_000_000_000;

/// A Polhemus.
pub struct PolhemusEmulator {
    config: EmulatorConfig,
    world: World,
    mood: Mood,
    heard: Vec<u8>,
    set: Settings,
    /// It starts up, and hears nothing.
    busy_until: i64,
    frame: u32,
    frame_nanos: i64,
    clock_zero_nanos: i64,
    speech: Speech,
}

impl PolhemusEmulator {
    /// A device that has just been switched on.
    pub fn new(config: EmulatorConfig, world: World) -> Self {
        Self {
            set: Settings::power_up(&config),
            busy_until: i64::MIN,
            speech: Speech::new(config.baud),
            config,
            world,
            mood: Mood::Well,
            heard: Vec::new(),
            frame: 0,
            frame_nanos: i64::MIN,
            clock_zero_nanos: 0,
        }
    }

    /// Makes it ill, or well again.
    pub fn set_mood(&mut self, mood: Mood) {
        self.mood = mood;
    }

    /// Ctrl-Y: it starts up as if it had been switched on.
    fn restart(&mut self, now_nanos: i64) {
        self.set = Settings::power_up(&self.config);
        self.heard.clear();
        (self.frame, self.clock_zero_nanos) = (0, now_nanos + START_UP_NANOS);
        self.busy_until = self.clock_zero_nanos;
    }

    /// Lets the frames go by that have ended by now.
    fn advance(&mut self, now_nanos: i64) {
        if self.frame_nanos == i64::MIN {
            self.frame_nanos = now_nanos;
        }
        let period = (1e9 / self.config.rate_hz) as i64;
        while self.frame_nanos + period <= now_nanos {
            self.frame_nanos += period;
            self.frame = self.frame.wrapping_add(1);
            match self.mood {
                Mood::Silent => {}
                Mood::WrongBaud => self.speech.say(self.frame_nanos, vec![0xE6, 0x18, 0x00, 0x7E, 0x98, 0xFE]),
                // A line that cannot take what is measured loses frames.
                Mood::Well if self.set.continuous && self.speech.free_at_nanos() <= self.frame_nanos + period => {
                    self.report(self.frame_nanos)
                }
                Mood::Well => {}
            }
        }
    }

    fn report(&mut self, at_nanos: i64) {
        for station in 1..=self.config.stations {
            let index = usize::from(station - 1);
            if !self.set.active[index] {
                continue;
            }
            let measured = at_nanos - self.config.latency_nanos;
            let (position, rotation) = (self.world)(station, measured);
            let position = self.reported(index, position, at_nanos);
            let unit = if self.set.centimetres { CENTIMETRE_M } else { INCH_M };
            let (roll, elevation, azimuth) = rotation.euler_angles();
            let ticks = (measured - self.clock_zero_nanos) as f64 * self.config.clock_rate * 1e-6;
            let record = Record {
                station,
                error: self.config.error,
                position_inches: (position / unit).map(|part| part as f32).into(),
                euler_deg: [azimuth, elevation, roll].map(|angle| angle.to_degrees() as f32),
                quaternion_wxyz: [rotation.w, rotation.i, rotation.j, rotation.k].map(|part| part as f32),
                time_stamp_ms: ticks.floor() as i64 as u32,
                frame: self.frame,
                distortion: self.config.distortion,
                pressed: false,
            };
            let bytes = if self.set.binary { encode(&record, &self.set.layouts[index]) } else { text(&record) };
            self.speech.say(at_nanos, bytes);
        }
    }
}

impl PolhemusEmulator {
    /// The position in the half of space that the station was told, or in the other one when it has changed its mind.
    fn reported(&self, index: usize, position: Vector3<f64>, nanos: i64) -> Vector3<f64> {
        let mirrored = self.set.hemispheres[index].dot(&position) < 0.0;
        let every = self.config.flip_every_nanos;
        let flipped = every > 0 && (nanos / every) % 2 != 0;
        if mirrored != flipped { -position } else { position }
    }
}

impl Emulated for PolhemusEmulator {
    fn hear(&mut self, bytes: &[u8], now_nanos: i64) {
        if self.mood != Mood::Well || now_nanos < self.busy_until {
            return;
        }
        self.advance(now_nanos);
        self.heard.extend_from_slice(bytes);
        while let Some((command, used)) = next_command(&self.heard, self.config.family) {
            self.heard.drain(..used);
            self.obey(&command, now_nanos);
        }
    }

    fn speak(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)> {
        self.advance(now_nanos);
        self.speech.leave(now_nanos)
    }
}

/// A record as it is sent until the host asks for binary ones.
fn text(record: &Record) -> Vec<u8> {
    let [x, y, z] = record.position_inches;
    let [a, e, r] = record.euler_deg;
    format!("0{}{} {x:7.2}{y:7.2}{z:7.2}{a:7.2}{e:7.2}{r:7.2}\r\n", record.station, char::from(record.error))
        .into_bytes()
}
