//! Where the flock is, how it is set, and what is known of its errors.

use crate::protocol::address::Addressing;
use crate::protocol::reading::Scale;
use crate::protocol::records::Format;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Settings of the line, of the flock, and of its poses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// The serial port. Names under /dev/serial/by-id stay the same when it is plugged in again.
    pub port: PathBuf,
    /// As the unit's switches 1 to 3 have it.
    pub baud: u32,
    /// Raise RTS. With a fully wired cable RTS holds the bird in standby, so: false.
    pub raise_rts: bool,
    /// Reset the bird by RTS at the start (needs a fully wired cable; takes 3 s).
    pub reset: bool,
    /// Addresses of the units with a sensor, ascending; none for a bird alone (address 0). They answer in
    /// group mode.
    pub sensors: Vec<u8>,
    /// How many boxes the flock has, an extended range controller included; 0: as many as the highest address.
    pub units: u8,
    /// As the switches have it.
    pub addressing: Addressing,
    /// What is sent: `position_matrix`, `position_angles` or `position_quaternion`.
    pub output: Format,
    /// Full scale in inches: 36 or 72; 144 with the extended range transmitter, which has no other.
    pub scale_inches: Scale,
    /// The half of space in which the sensor is when the node starts, seen from the transmitter.
    pub hemisphere: Hemisphere,
    /// Follow the sensor into the other half of space, by continuity.
    pub follow_hemisphere: bool,
    /// Of the mains: 50 in Europe, 60 in America.
    pub line_frequency_hz: u8,
    /// Measurements a second, 20 to 144.
    pub rate_hz: f64,
    /// Send every 1st, 2nd, 8th or 32nd measurement.
    pub report_every: u8,
    /// Beside a simulated camera: stamps count from the beginning of the scan, as that camera's do.
    pub scan_clock: bool,
    /// The six-tap filter against the mains: quieter, and older by two and a half measurements.
    pub ac_wide_filter: bool,
    /// The two-tap filter against the mains: older by half a measurement.
    pub ac_narrow_filter: bool,
    /// The adaptive filter: quiet at rest (time constant 0.5 s), quick in motion.
    pub dc_filter: bool,
    /// Its smallest gain in each of the seven ranges; none: as the bird has it (0.02).
    pub dc_alpha_min: Option<[f64; 7]>,
    /// Its largest gain in each of the seven ranges; none: as the bird has it (0.9).
    pub dc_alpha_max: Option<[f64; 7]>,
    /// The motion from which its gain rises, in each of the seven ranges; none: as the bird has it (2 to 512). The
    /// default is the maker's set for quick hands.
    pub dc_motion: Option<[u16; 7]>,
    /// Hold the last pose when it jumps.
    pub sudden_change_lock: bool,
    /// Ask for the measure of metal with every record.
    pub metal: bool,
    /// From this measure of metal on (0 to 127) a pose counts as degraded, and its sigma grows in proportion.
    pub most_metal: u8,
    /// How old a position is when its record leaves; none: 7.5 ms (Adelstein et al. 1996) and what the AC filters add.
    pub position_latency_ms: Option<f64>,
    /// How old an orientation is when its record leaves; none: 2 ms and what the AC filters add.
    pub rotation_latency_ms: Option<f64>,
    /// One standard deviation of a position near the transmitter, along each axis (data sheet: 1.8 mm rms).
    pub position_sigma_mm: f64,
    /// One standard deviation of an orientation near the transmitter, about each axis (data sheet: 0.5 degrees rms).
    pub rotation_sigma_deg: f64,
    /// Up to this distance the data sheet holds (30 inches);
    /// farther away the signal falls with the cube of the distance: sigma grows with the fourth power, and a pose counts
    /// as degraded.
    pub good_to_m: f64,
}

/// Half of the space around the transmitter: x away from its cable, y to the right, z down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hemisphere {
    /// +x.
    #[default]
    Forward,
    /// -x.
    Aft,
    /// -z.
    Upper,
    /// +z.
    Lower,
    /// -y.
    Left,
    /// +y.
    Right,
}

impl Hemisphere {
    /// Axis and sign as the commands have them.
    pub fn code(self) -> [u8; 2] {
        match self {
            Self::Forward => [0x00, 0],
            Self::Aft => [0x00, 1],
            Self::Upper => [0x0C, 1],
            Self::Lower => [0x0C, 0],
            Self::Left => [0x06, 1],
            Self::Right => [0x06, 0],
        }
    }

    /// The axis, 0 to 2, and its sign in this half.
    pub fn axis(self) -> (usize, f64) {
        match self {
            Self::Forward => (0, 1.0),
            Self::Aft => (0, -1.0),
            Self::Upper => (2, -1.0),
            Self::Lower => (2, 1.0),
            Self::Left => (1, -1.0),
            Self::Right => (1, 1.0),
        }
    }
}

impl Default for Config {
    fn default() -> Self {
        Self {
            port: PathBuf::from("/dev/ttyUSB0"),
            baud: 115_200,
            raise_rts: false,
            reset: false,
            sensors: Vec::new(),
            units: 0,
            addressing: Addressing::Normal,
            output: Format::PositionMatrix,
            scale_inches: Scale::Inches36,
            hemisphere: Hemisphere::Forward,
            follow_hemisphere: true,
            line_frequency_hz: 50,
            rate_hz: 103.0,
            report_every: 1,
            scan_clock: false,
            ac_wide_filter: false,
            ac_narrow_filter: true,
            dc_filter: true,
            dc_alpha_min: None,
            dc_alpha_max: None,
            dc_motion: Some([2, 2, 2, 10, 10, 40, 200]),
            sudden_change_lock: false,
            metal: false,
            most_metal: 20,
            position_latency_ms: None,
            rotation_latency_ms: None,
            position_sigma_mm: 1.8,
            rotation_sigma_deg: 0.5,
            good_to_m: 0.762,
        }
    }
}

/// A setting that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("tracker_flock: {key} = {value}: {wanted}")]
pub struct ConfigError {
    /// The key.
    pub key: &'static str,
    /// What it holds.
    pub value: String,
    /// What it should hold.
    pub wanted: &'static str,
}

/// The rates that the switches know.
const BAUDS: [u32; 7] = [2400, 4800, 9600, 19200, 38400, 57600, 115_200];

impl Config {
    /// Refuses what a flock cannot do.
    pub fn check(&self) -> Result<(), ConfigError> {
        let refuse = |key, value: String, wanted| Err(ConfigError { key, value, wanted });
        if self.port.as_os_str().is_empty() {
            return refuse("port", "\"\"".to_owned(), "name the serial port; `limn devices` lists them");
        }
        if !BAUDS.contains(&self.baud) {
            return refuse(
                "baud",
                self.baud.to_string(),
                "2400, 4800, 9600, 19200, 38400, 57600 or 115200, as its switches",
            );
        }
        let ascending = self.sensors.windows(2).all(|pair| pair[0] < pair[1]);
        if !ascending || self.sensors.iter().any(|&address| address == 0 || address > self.addressing.most()) {
            return refuse(
                "sensors",
                format!("{:?}", self.sensors),
                "addresses from 1 on, ascending, within `addressing`",
            );
        }
        if self.units > self.addressing.most() || (self.units != 0 && self.units < self.highest()) {
            return refuse(
                "units",
                self.units.to_string(),
                "at least the highest address of `sensors`, within `addressing`",
            );
        }
        if !matches!(self.output, Format::PositionAngles | Format::PositionMatrix | Format::PositionQuaternion) {
            return refuse("output", format!("{:?}", self.output), "a pose needs position and orientation");
        }
        if !matches!(self.line_frequency_hz, 50 | 60) {
            return refuse("line_frequency_hz", self.line_frequency_hz.to_string(), "50 or 60");
        }
        if !matches!(self.report_every, 1 | 2 | 8 | 32) {
            return refuse("report_every", self.report_every.to_string(), "1, 2, 8 or 32");
        }
        self.check_numbers()
    }

    fn check_numbers(&self) -> Result<(), ConfigError> {
        let gains = [("dc_alpha_min", self.dc_alpha_min), ("dc_alpha_max", self.dc_alpha_max)];
        let gains = gains.into_iter().flat_map(|(key, table)| {
            table.into_iter().flatten().map(move |gain| (key, gain, 0.0, 0.99997, "gains from 0 to 0.99997"))
        });
        let latencies = [
            ("position_latency_ms", self.position_latency_ms.unwrap_or(0.0), -100.0, 1000.0, "-100 to 1000 ms"),
            ("rotation_latency_ms", self.rotation_latency_ms.unwrap_or(0.0), -100.0, 1000.0, "-100 to 1000 ms"),
        ];
        let others = [
            ("rate_hz", self.rate_hz, 20.0, 144.0, "20 to 144"),
            ("most_metal", f64::from(self.most_metal), 1.0, 127.0, "1 to 127"),
            ("position_sigma_mm", self.position_sigma_mm, 1e-3, 1000.0, "0.001 to 1000 mm"),
            ("rotation_sigma_deg", self.rotation_sigma_deg, 1e-3, 90.0, "0.001 to 90 degrees"),
            ("good_to_m", self.good_to_m, 0.05, 10.0, "0.05 to 10 m"),
        ];
        for (key, value, least, most, wanted) in gains.chain(latencies).chain(others) {
            if !(value >= least && value <= most) {
                return Err(ConfigError { key, value: value.to_string(), wanted });
            }
        }
        Ok(())
    }

    /// The addresses that are spoken to: 0 for a bird alone.
    pub fn addresses(&self) -> Vec<u8> {
        if self.sensors.is_empty() { vec![0] } else { self.sensors.clone() }
    }

    /// True when units answer together, each record with its address; false for a bird alone.
    pub fn is_group(&self) -> bool {
        !self.sensors.is_empty()
    }

    /// How many boxes the flock has; 0 for a bird alone.
    pub fn unit_count(&self) -> u8 {
        if self.units == 0 { self.highest() } else { self.units }
    }

    fn highest(&self) -> u8 {
        self.sensors.last().copied().unwrap_or(0)
    }

    /// Data of parameter 3; none with the extended range transmitter.
    pub(crate) fn scale_code(&self) -> Option<u16> {
        match self.scale_inches {
            Scale::Inches36 => Some(0),
            Scale::Inches72 => Some(1),
            Scale::Inches144 => None,
        }
    }

    /// Data of parameter 4: filters that are off.
    pub(crate) fn filters_off(&self) -> u16 {
        u16::from(!self.ac_narrow_filter) << 2 | u16::from(!self.ac_wide_filter) << 1 | u16::from(!self.dc_filter)
    }

    /// Name, parameter and data of the tables of the adaptive filter that are to be changed.
    pub(crate) fn filter_tables(&self) -> Vec<(&'static str, u8, [u16; 7])> {
        let gains = |table: [f64; 7]| table.map(|gain| (gain * 32768.0).round() as u16);
        let least = self.dc_alpha_min.map(|table| ("dc_alpha_min", 5, gains(table)));
        let motion = self.dc_motion.map(|table| ("dc_motion", 12, table));
        let most = self.dc_alpha_max.map(|table| ("dc_alpha_max", 13, gains(table)));
        [least, motion, most].into_iter().flatten().collect()
    }

    /// How old position and rotation are when their record leaves, in nanoseconds.
    pub fn latencies_nanos(&self) -> (i64, i64) {
        const WIDE_CYCLES: f64 = 2.5;
        const NARROW_CYCLES: f64 = 0.5;
        let wide = if self.ac_wide_filter { WIDE_CYCLES } else { 0.0 };
        let narrow = if self.ac_narrow_filter { NARROW_CYCLES } else { 0.0 };
        let filters_ms = (wide + narrow) * 1e3 / self.rate_hz;
        let nanos = |latency_ms: Option<f64>, unfiltered_ms| {
            (latency_ms.unwrap_or(unfiltered_ms + filters_ms) * 1e6).round() as i64
        };
        (nanos(self.position_latency_ms, 7.5), nanos(self.rotation_latency_ms, 2.0))
    }
}
