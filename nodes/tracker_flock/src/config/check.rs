//! What a flock cannot do.

use super::Config;
use crate::protocol::records::Format;
use serial_line::ConfigError;

const NODE: &str = "tracker_flock";
/// The rates that the switches know.
const BAUDS: [u32; 7] = [2400, 4800, 9600, 19200, 38400, 57600, 115_200];

impl Config {
    /// Refuses what a flock cannot do.
    pub fn check(&self) -> Result<(), ConfigError> {
        let refuse = |key, value: String, wanted| Err(ConfigError { node: NODE, key, value, wanted });
        let bauds = "2400, 4800, 9600, 19200, 38400, 57600 or 115200, as its switches";
        ConfigError::unless_line(NODE, &self.port, (self.baud, |baud| BAUDS.contains(&baud), bauds))?;
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
        gains.chain(latencies).chain(others).try_for_each(|range| ConfigError::unless_within(NODE, range))
    }
}
