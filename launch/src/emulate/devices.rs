//! The devices that can be played, and what can be asked of each.

use super::Common;
use super::hand::Beginning;
use super::mood::{FlockMood, PolhemusMood};
use anyhow::{Result, ensure};
use tracker_flock::emulator::FlockEmulator;
use tracker_polhemus::emulator::PolhemusEmulator;
use tracker_polhemus::protocol::records::Family;

/// One of them.
#[derive(Debug, clap::Subcommand)]
pub enum Device {
    /// An Ascension Flock of Birds: one bird alone, or several in group mode.
    Flock(Box<Flock>),
    /// A Polhemus Fastrak, Liberty or Patriot.
    Polhemus(Box<Polhemus>),
}

/// A button of a bird's mouse, with the byte that tells it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Button {
    /// None of them.
    None = 0x00,
    /// The left one.
    Left = 0x10,
    /// The one in the middle.
    Middle = 0x30,
    /// The right one.
    Right = 0x70,
}

/// A Flock of Birds.
#[derive(Debug, clap::Args)]
pub struct Flock {
    /// How many units, addresses from 1, that answer in group mode; 0 is a bird alone.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=14))]
    pub units: u8,
    /// The address of the first unit with a sensor: those before it are extended range controllers.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=14))]
    pub first_sensor: u8,
    /// As its switches have it; 0 is a line that takes no time.
    #[arg(long, value_name = "N", default_value_t = 115_200)]
    pub baud: u32,
    /// Measurements a second, 20 to 144, until the host asks for another rate.
    #[arg(long, value_name = "N", default_value_t = 103.0)]
    pub rate_hz: f64,
    /// The measure of metal that it tells, 0 to 127.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u8).range(0..=127))]
    pub metal: u8,
    /// The button of its mouse that is held down.
    #[arg(long, value_enum, default_value_t = Button::None)]
    pub button: Button,
    /// Its own adaptive filter: steady at rest, late in motion. Beside the one that the rig file's tracker has.
    #[arg(long)]
    pub adaptive_filter: bool,
    /// It changes its mind so often about the half of space that its sensors are in.
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    pub flip_every: f64,
    /// What is wrong with it.
    #[arg(long, value_enum, default_value_t = FlockMood::Well)]
    pub mood: FlockMood,
    /// The error that it reports when it is asked first, by its number in the manual.
    #[arg(long, value_name = "CODE", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=35))]
    pub error: u8,
    #[command(flatten)]
    pub(super) common: Common,
}

impl Flock {
    /// The flock, switched on.
    pub(super) fn emulator(&self, beginning: &Beginning) -> Result<FlockEmulator> {
        ensure!((20.0..=144.0).contains(&self.rate_hz), "--rate-hz {}: 20 to 144", self.rate_hz);
        ensure!((0.0..=1e6).contains(&self.flip_every), "--flip-every {}: 0 to 1000000 s", self.flip_every);
        let (first, units) = (self.first_sensor, self.units);
        ensure!(first <= units.max(1), "--first-sensor {first}: there are {units} units");
        let config = tracker_flock::emulator::EmulatorConfig {
            units,
            first_sensor: first,
            baud: self.baud,
            rate_hz: self.rate_hz,
            filters: self.adaptive_filter,
            metal: self.metal,
            button: self.button as u8,
            flip_every_nanos: (self.flip_every * 1e9) as i64,
            error: self.error,
            ..Default::default()
        };
        let mut flock = FlockEmulator::new(config, self.common.hand.sensors(first, beginning.clone())?);
        flock.set_mood(self.mood.into());
        Ok(flock)
    }
}

/// A Polhemus.
#[derive(Debug, clap::Args)]
pub struct Polhemus {
    /// `fastrak`, `liberty` or `patriot`.
    #[arg(long, value_name = "NAME", default_value = "liberty", value_parser = family)]
    pub family: Family,
    /// How many stations have a sensor.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub stations: u8,
    /// As its switches have it; 0 is a line that takes no time.
    #[arg(long, value_name = "N", default_value_t = 115_200)]
    pub baud: u32,
    /// Records a second from each station; the family's own when not said.
    #[arg(long, value_name = "N")]
    pub rate_hz: Option<f64>,
    /// The level of distortion that it tells: metal is near.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true)]
    pub distortion: i32,
    /// It changes its mind so often about the half of space that its sensors are in.
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    pub flip_every: f64,
    /// What is wrong with it.
    #[arg(long, value_enum, default_value_t = PolhemusMood::Well)]
    pub mood: PolhemusMood,
    /// The letter with which each record says that something is wrong, as the manual has it; a space when all is well.
    #[arg(long, value_name = "LETTER", default_value_t = ' ', value_parser = letter)]
    pub error: char,
    #[command(flatten)]
    pub(super) common: Common,
}

impl Polhemus {
    /// The device, switched on.
    pub(super) fn emulator(&self, beginning: &Beginning) -> Result<PolhemusEmulator> {
        let most = self.family.most_stations();
        ensure!((0.0..=1e6).contains(&self.flip_every), "--flip-every {}: 0 to 1000000 s", self.flip_every);
        ensure!((1..=most).contains(&self.stations), "--stations {}: a {:?} has {most}", self.stations, self.family);
        let stations = (1..=self.stations).collect();
        let driver =
            tracker_polhemus::Config { family: self.family, stations, rate_hz: self.rate_hz, ..Default::default() };
        driver.check()?;
        let config = tracker_polhemus::emulator::EmulatorConfig {
            stations: self.stations,
            baud: self.baud,
            rate_hz: driver.sheet().rate_hz,
            distortion: self.distortion,
            flip_every_nanos: (self.flip_every * 1e9) as i64,
            error: u8::try_from(self.error)?,
            ..tracker_polhemus::emulator::EmulatorConfig::of(self.family)
        };
        let mut device = PolhemusEmulator::new(config, self.common.hand.sensors(1, beginning.clone())?);
        device.set_mood(self.mood.into());
        Ok(device)
    }
}

fn letter(text: &str) -> Result<char, String> {
    let mut letters = text.chars();
    match (letters.next(), letters.next()) {
        (Some(letter), None) if letter.is_ascii_graphic() || letter == ' ' => Ok(letter),
        _ => Err("one letter of ASCII".to_owned()),
    }
}

fn family(name: &str) -> Result<Family, String> {
    serde_json::from_value(serde_json::Value::from(name)).map_err(|_| "fastrak, liberty or patriot".to_owned())
}
