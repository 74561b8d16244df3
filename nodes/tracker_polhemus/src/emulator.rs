//! A Fastrak, Liberty or Patriot that is played, byte for byte: commands in, records and answers out, each with its time.
//! No port and no clock of its own; `serial_line::Pty` puts it behind a pseudo-terminal.

use crate::protocol::records::{Family, Item, Layout, Record, encode};
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{Emulated, Speech};

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
        }
    }
}

/// Where the sensor of a station is at a moment, in the frame of the source.
pub type World = Box<dyn Fn(u8, i64) -> (Vector3<f64>, UnitQuaternion<f64>) + Send>;

/// What is wrong with it, for tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mood {
    /// Nothing.
    Well,
    /// It says nothing.
    Silent,
    /// Its baud rate is another: nothing that it says is understood, nor what it hears.
    WrongBaud,
}

/// A Polhemus.
pub struct PolhemusEmulator {
    config: EmulatorConfig,
    world: World,
    mood: Mood,
    heard: Vec<u8>,
    layouts: Vec<Layout>,
    active: Vec<bool>,
    binary: bool,
    centimetres: bool,
    continuous: bool,
    frame: u32,
    frame_nanos: i64,
    clock_zero_nanos: i64,
    speech: Speech,
}

impl PolhemusEmulator {
    /// A device that has just been switched on.
    pub fn new(config: EmulatorConfig, world: World) -> Self {
        let layout = Layout { family: config.family, items: vec![Item::Position, Item::Euler, Item::CrLf] };
        let stations = usize::from(config.stations);
        Self {
            layouts: vec![layout; stations],
            active: vec![true; stations],
            speech: Speech::new(config.baud),
            config,
            world,
            mood: Mood::Well,
            heard: Vec::new(),
            binary: false,
            centimetres: false,
            continuous: false,
            frame: 0,
            frame_nanos: i64::MIN,
            clock_zero_nanos: 0,
        }
    }

    /// Makes it ill, or well again.
    pub fn set_mood(&mut self, mood: Mood) {
        self.mood = mood;
    }

    fn obey(&mut self, command: &str, now: i64) {
        let fastrak = self.config.family == Family::Fastrak;
        let mut letters = command.chars();
        let (letter, rest) = (letters.next().unwrap_or('\r'), letters.as_str());
        let mut numbers = rest.split(',').map(|number| number.trim().parse::<i64>().unwrap_or(-1));
        match letter {
            'c' if fastrak => self.continuous = false,
            'C' => self.continuous = true,
            'P' => {
                self.continuous = false;
                self.report(now);
            }
            'f' if fastrak => self.binary = true,
            'F' => self.binary = rest == "1",
            'U' if fastrak => self.centimetres = false,
            'u' if fastrak => self.centimetres = true,
            'U' => self.centimetres = rest == "1",
            'Q' => self.clock_zero_nanos = now,
            'S' if fastrak => {
                let flags = u8::from(self.binary) | u8::from(self.centimetres) << 1 | u8::from(self.continuous) << 3;
                let name = format!("2 S{flags:03X}000      3.01  {:<32}\r\n", "3SPACE FASTRAK, emulated");
                self.speech.say(now, name.into_bytes());
            }
            '\x16' => {
                let name = if self.config.family == Family::Patriot { "Patriot" } else { "Liberty" };
                self.speech.say(now, format!("{:<194}\r\n", format!("0 Polhemus {name}, emulated")).into_bytes());
            }
            'l' if fastrak => {
                let (station, on) = (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0));
                if let Some(active) = self.active.get_mut((station - 1).max(0) as usize) {
                    *active = on == 1;
                }
            }
            'O' => {
                let station = numbers.next().unwrap_or(0);
                let items = numbers.filter_map(|code| item_of(code, self.config.family)).collect();
                if let Some(layout) = self.layouts.get_mut((station - 1).max(0) as usize) {
                    layout.items = items;
                }
            }
            _ => {}
        }
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
                Mood::Well if self.continuous && self.speech.free_at_nanos() <= self.frame_nanos + period => {
                    self.report(self.frame_nanos)
                }
                Mood::Well => {}
            }
        }
    }

    fn report(&mut self, at_nanos: i64) {
        for station in 1..=self.config.stations {
            let index = usize::from(station - 1);
            if !self.active[index] {
                continue;
            }
            let measured = at_nanos - self.config.latency_nanos;
            let (position, rotation) = (self.world)(station, measured);
            let unit = if self.centimetres { CENTIMETRE_M } else { INCH_M };
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
            let bytes = if self.binary { encode(&record, &self.layouts[index]) } else { text(&record) };
            self.speech.say(at_nanos, bytes);
        }
    }
}

impl Emulated for PolhemusEmulator {
    fn hear(&mut self, bytes: &[u8], now_nanos: i64) {
        if self.mood != Mood::Well {
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

/// The first whole command, and how many bytes it has. A Fastrak knows many of its commands by their letter; what has
/// arguments ends with CR.
fn next_command(heard: &[u8], family: Family) -> Option<(String, usize)> {
    let first = *heard.first()?;
    let alone = match family {
        Family::Fastrak => b"PcCfFUuSWYt\x19\x0B\r".contains(&first),
        // A single record is the one command that does not wait for CR.
        _ => matches!(first, b'P' | b'\r'),
    };
    if alone {
        return Some((char::from(first).to_string(), 1));
    }
    let end = heard.iter().position(|&byte| byte == b'\r')?;
    Some((String::from_utf8_lossy(&heard[..end]).into_owned(), end + 1))
}

fn item_of(code: i64, family: Family) -> Option<Item> {
    const ALL: [Item; 10] = [
        Item::Space,
        Item::CrLf,
        Item::Position,
        Item::PositionPrecise,
        Item::Euler,
        Item::Quaternion,
        Item::TimeStamp,
        Item::FrameCount,
        Item::Stylus,
        Item::Distortion,
    ];
    ALL.into_iter().find(|item| item.code(family).map(i64::from) == Some(code))
}

/// A record as it is sent until the host asks for binary ones.
fn text(record: &Record) -> Vec<u8> {
    let [x, y, z] = record.position_inches;
    let [a, e, r] = record.euler_deg;
    format!("0{}{} {x:7.2}{y:7.2}{z:7.2}{a:7.2}{e:7.2}{r:7.2}\r\n", record.station, char::from(record.error))
        .into_bytes()
}
