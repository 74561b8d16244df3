//! Where the tracker is, how it is set, and what is known of its errors.

use crate::protocol::records::Family;
use serde::{Deserialize, Serialize};
use serial_line::ConfigError;
use std::path::PathBuf;

/// Settings of the line, of the device, and of its poses. What is none is the family's own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// The serial port. Names under /dev/serial/by-id stay the same when it is plugged in again.
    pub port: PathBuf,
    /// As the device's switches have it.
    pub baud: u32,
    /// `fastrak`, `liberty` or `patriot`.
    pub family: Family,
    /// Stations with a sensor, ascending, from 1.
    pub stations: Vec<u8>,
    /// A vector from the source into the half of space where the sensors are when the node starts; [0, 0, 0]: the device
    /// follows by itself.
    pub hemisphere: [f64; 3],
    /// Follow a sensor into the other half of space, by continuity.
    pub follow_hemisphere: bool,
    /// The device's own adaptive filter, at the maker's suggestion of 0.2, 0.2, 0.8, 0.8.
    pub filter: bool,
    /// Records a second from each station: 120 shared among the stations of a Fastrak, 60 Patriot, 240 or 120 Liberty
    /// (240 for one station: two would not go through 115200 baud).
    pub rate_hz: Option<f64>,
    /// Beside a simulated camera: stamps count from the beginning of the scan, as that camera's do.
    pub scan_clock: bool,
    /// How old a pose is when its record leaves: 4 ms Fastrak, 3.5 Liberty, 18.5 Patriot (data sheets).
    pub latency_ms: Option<f64>,
    /// One standard deviation of a position near the source, along each axis: 0.76 mm, Patriot 1.5 (data sheets).
    pub position_sigma_mm: Option<f64>,
    /// One standard deviation of an orientation near the source, about each axis: 0.15 degrees, Patriot 0.4 (data sheets).
    pub rotation_sigma_deg: Option<f64>,
    /// Up to this distance the data sheet holds: 0.76 m, Liberty 0.9. Farther away the signal falls with the cube of the
    /// distance: sigma grows with the fourth power, and a pose counts as degraded.
    pub good_to_m: Option<f64>,
    /// From this level of distortion on (Liberty, Patriot) a pose counts as degraded, and its sigma grows in proportion.
    /// The scale is the device's own: look at what it says where nothing is near.
    pub most_distortion: i32,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            port: PathBuf::from("/dev/ttyUSB0"),
            baud: 115_200,
            family: Family::Liberty,
            stations: vec![1],
            hemisphere: [1.0, 0.0, 0.0],
            follow_hemisphere: true,
            filter: false,
            rate_hz: None,
            scan_clock: false,
            latency_ms: None,
            position_sigma_mm: None,
            rotation_sigma_deg: None,
            good_to_m: None,
            most_distortion: 100,
        }
    }
}

/// What the data sheets say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DataSheet {
    /// Records a second from each station.
    pub rate_hz: f64,
    /// How old a pose is when its record leaves.
    pub latency_ms: f64,
    /// One standard deviation of a position near the source.
    pub position_sigma_mm: f64,
    /// One standard deviation of an orientation near the source.
    pub rotation_sigma_deg: f64,
    /// Up to where this holds.
    pub good_to_m: f64,
}

const NODE: &str = "tracker_polhemus";
/// The rates that the devices have.
const BAUDS: [u32; 8] = [1200, 2400, 4800, 9600, 19_200, 38_400, 57_600, 115_200];

impl Config {
    /// Refuses what the device cannot do.
    pub fn check(&self) -> Result<(), ConfigError> {
        let refuse = |key, value: String, wanted| Err(ConfigError { node: NODE, key, value, wanted });
        let bauds = "1200 to 115200, as its switches have it";
        ConfigError::unless_line(NODE, &self.port, (self.baud, |baud| BAUDS.contains(&baud), bauds))?;
        let ascending = self.stations.windows(2).all(|pair| pair[0] < pair[1]);
        let there = |station: &u8| (1..=self.family.most_stations()).contains(station);
        if self.stations.is_empty() || !ascending || !self.stations.iter().all(there) {
            return refuse(
                "stations",
                format!("{:?}", self.stations),
                "from 1 on, ascending, as many as the family has",
            );
        }
        if !self.hemisphere.iter().all(|part| part.abs() <= 1e3) {
            return refuse("hemisphere", format!("{:?}", self.hemisphere), "a vector of finite numbers");
        }
        if self.most_distortion < 1 {
            return refuse("most_distortion", self.most_distortion.to_string(), "at least 1");
        }
        let sheet = self.sheet();
        for range in [
            ("rate_hz", sheet.rate_hz, 1.0, 1000.0, "1 to 1000"),
            ("latency_ms", sheet.latency_ms, -100.0, 1000.0, "-100 to 1000 ms"),
            ("position_sigma_mm", sheet.position_sigma_mm, 1e-3, 1000.0, "0.001 to 1000 mm"),
            ("rotation_sigma_deg", sheet.rotation_sigma_deg, 1e-3, 90.0, "0.001 to 90 degrees"),
            ("good_to_m", sheet.good_to_m, 0.05, 10.0, "0.05 to 10 m"),
        ] {
            ConfigError::unless_within(NODE, range)?;
        }
        Ok(())
    }

    /// The family's data sheet, with what the configuration knows better.
    pub fn sheet(&self) -> DataSheet {
        let [rate_hz, latency_ms, position_sigma_mm, rotation_sigma_deg, good_to_m] = match self.family {
            Family::Fastrak => [120.0 / self.stations.len().max(1) as f64, 4.0, 0.76, 0.15, 0.76],
            Family::Liberty if self.stations.len() > 1 => [120.0, 3.5, 0.76, 0.15, 0.9],
            Family::Liberty => [240.0, 3.5, 0.76, 0.15, 0.9],
            Family::Patriot => [60.0, 18.5, 1.5, 0.4, 0.76],
        };
        DataSheet {
            rate_hz: self.rate_hz.unwrap_or(rate_hz),
            latency_ms: self.latency_ms.unwrap_or(latency_ms),
            position_sigma_mm: self.position_sigma_mm.unwrap_or(position_sigma_mm),
            rotation_sigma_deg: self.rotation_sigma_deg.unwrap_or(rotation_sigma_deg),
            good_to_m: self.good_to_m.unwrap_or(good_to_m),
        }
    }
}
