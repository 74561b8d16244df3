//! Which lights there are, and how they are switched.

use crate::protocol::Dialect;
use serde::{Deserialize, Serialize};
use serial_line::ConfigError;
use std::path::PathBuf;

/// Where the lights are, and what they do in each phase.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// The serial port. Names under /dev/serial/by-id stay the same when it is plugged in again.
    pub port: PathBuf,
    /// Bits a second.
    pub baud: u32,
    /// What it understands: `limn` (the sketch in docs/hardware.md) or `horus` (the board of a Ciclop).
    pub dialect: Dialect,
    /// In phase `both`, how long the laser is on.
    pub laser_ms: u32,
    /// In phase `both`, how long the lamp is on: three pictures at least, of which the middle one is lit by it alone.
    pub lamp_ms: u32,
    /// The laser is on while the operator aims.
    pub aim_with_laser: bool,
    /// `horus`: the output of the laser, 1 or 2.
    pub horus_laser: u8,
    /// `horus`: the output where the lamp is connected, 1 or 2; none: there is no lamp.
    pub horus_lamp: Option<u8>,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            port: PathBuf::from("/dev/ttyACM0"),
            baud: 115_200,
            dialect: Dialect::Limn,
            laser_ms: 500,
            lamp_ms: 100,
            aim_with_laser: true,
            horus_laser: 1,
            horus_lamp: None,
        }
    }
}

const NODE: &str = "light";

impl Config {
    /// Refuses what no lights can do.
    pub fn check(&self) -> Result<(), ConfigError> {
        let refuse = |key, value: String, wanted| Err(ConfigError { node: NODE, key, value, wanted });
        let bauds = 1200..=4_000_000;
        ConfigError::unless_line(NODE, &self.port, (self.baud, |baud| bauds.contains(&baud), "1200 to 4000000"))?;
        for (key, millis) in [("laser_ms", self.laser_ms), ("lamp_ms", self.lamp_ms)] {
            if !(10..=60_000).contains(&millis) {
                return refuse(key, millis.to_string(), "10 to 60000");
            }
        }
        let outputs = 1..=2;
        if !outputs.contains(&self.horus_laser) {
            return refuse("horus_laser", self.horus_laser.to_string(), "1 or 2");
        }
        match self.horus_lamp {
            Some(lamp) if !outputs.contains(&lamp) || lamp == self.horus_laser => {
                refuse("horus_lamp", lamp.to_string(), "1 or 2, and not the laser's")
            }
            _ => Ok(()),
        }
    }
}
