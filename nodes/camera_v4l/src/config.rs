//! Which camera, how it is set, and how its stamps are read.

use crate::exposure::ExposureConfig;
use crate::granted::{SIZE, STRIDE};
use crate::look::LightConfig;
use crate::pixels::{DriverFormat, Levels};
use crate::stamp::StampAt;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What is asked of the camera. What is none is left as the camera has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// The camera. Names under /dev/v4l/by-id stay the same when it is plugged in again; `limn devices` lists them.
    pub device: PathBuf,
    /// `GREY`, `YUYV`, `RGB3`, `BGR3` or `MJPG`.
    pub format: DriverFormat,
    /// Which levels `YUYV` uses: `driver` (as it says), `limited` (16 to 235) or `full`.
    pub levels: Levels,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Pictures a second.
    pub rate_hz: f64,
    /// How long the shutter is open; the camera's own automatics are switched off for it.
    pub exposure_us: Option<f64>,
    /// In the camera's own steps; its automatics are switched off for it.
    pub gain: Option<i64>,
    /// Colour temperature in kelvin; the camera's automatics are switched off for it.
    pub white_balance_k: Option<i64>,
    /// Other controls by the names that `limn devices` prints: `controls = { sharpness = 0 }`.
    pub controls: BTreeMap<String, i64>,
    /// What the driver may set otherwise than asked: `format`, `rate`, `exposure`, `gain`, `white_balance`, the name of a
    /// control, or an automatic that stays on (`exposure_automatic`, `exposure_slows_rate`, `gain_automatic`,
    /// `white_balance_automatic`). Anything else that differs is an error.
    pub may_differ: Vec<String>,
    /// The step of `gain` that stands for no gain; none: nobody knows, and pictures say 1.
    pub gain_unit: Option<f64>,
    /// The camera's exponent: grey level = 255 (light)^(1/gamma); 1 for industrial cameras.
    pub gamma: f32,
    /// What the driver's stamp tells: `driver`, `start`, `end` or `arrival`.
    pub stamp_at: StampAt,
    /// How much later than that the stamp is; what is left is found by calibration as `pose_offset_s`.
    pub stamp_delay_us: f64,
    /// Pictures that the driver may fill while one is fetched.
    pub buffers: u32,
    /// Following the stripe's brightness.
    pub exposure: ExposureConfig,
    /// Seeing what lit a picture.
    pub light: LightConfig,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            device: PathBuf::from("/dev/video0"),
            format: DriverFormat::Yuyv,
            levels: Levels::Driver,
            width: 640,
            height: 480,
            rate_hz: 30.0,
            exposure_us: None,
            gain: None,
            white_balance_k: None,
            controls: BTreeMap::new(),
            may_differ: Vec::new(),
            gain_unit: None,
            gamma: 2.2,
            stamp_at: StampAt::Driver,
            stamp_delay_us: 0.0,
            buffers: 4,
            exposure: ExposureConfig::default(),
            light: LightConfig::default(),
        }
    }
}

/// A setting that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("camera_v4l: {key} = {value}: {wanted}")]
pub struct ConfigError {
    /// The key.
    pub key: &'static str,
    /// What it holds.
    pub value: String,
    /// What it should hold.
    pub wanted: &'static str,
}

impl Config {
    /// Refuses what no camera can do.
    pub fn check(&self) -> Result<(), ConfigError> {
        let refuse = |key, value: String, wanted| Err(ConfigError { key, value, wanted });
        if self.device.as_os_str().is_empty() {
            return refuse("device", "\"\"".to_owned(), "name the camera; `limn devices` lists them");
        }
        for (key, value) in [("width", self.width), ("height", self.height)] {
            if !(1..=16_384).contains(&value) {
                return refuse(key, value.to_string(), "1 to 16384 pixels");
            }
        }
        if !(2..=32).contains(&self.buffers) {
            return refuse("buffers", self.buffers.to_string(), "2 to 32");
        }
        if self.may_differ.iter().any(|name| name == SIZE || name == STRIDE) {
            let wanted = "not `size`, which would fit no rig, nor `stride`, which would be no picture";
            return refuse("may_differ", format!("{:?}", self.may_differ), wanted);
        }
        let (exposure, light) = (&self.exposure, &self.light);
        let most_us = exposure.most_us;
        for (key, value, least, most, wanted) in [
            ("rate_hz", self.rate_hz, 0.1, 10_000.0, "0.1 to 10000"),
            ("exposure_us", self.exposure_us.unwrap_or(1.0), 1.0, 1e7, "1 to 10000000"),
            ("gain_unit", self.gain_unit.unwrap_or(1.0), 1e-6, 1e9, "above 0"),
            ("gamma", f64::from(self.gamma), 0.2, 5.0, "0.2 to 5"),
            ("stamp_delay_us", self.stamp_delay_us, -1e6, 1e6, "-1000000 to 1000000"),
            ("exposure.target_peak", f64::from(exposure.target_peak), 20.0, 4000.0, "20 to 4000 grey levels"),
            ("exposure.most_saturated", f64::from(exposure.most_saturated), 0.0, 1.0, "0 to 1"),
            ("exposure.dead_band", f64::from(exposure.dead_band), 1.0, 2.0, "1 to 2"),
            ("exposure.most_us", most_us, 1.0, 1e7, "1 to 10000000"),
            ("exposure.least_us", exposure.least_us, 1.0, most_us, "1 to exposure.most_us"),
            ("exposure.most_gain", exposure.most_gain, 1.0, 1000.0, "1 to 1000"),
            ("light.stripe_height", f64::from(light.stripe_height), 1.0, 4000.0, "1 to 4000 grey levels"),
            ("light.stripe_share", f64::from(light.stripe_share), 0.0, 1.0, "0 to 1"),
            ("light.lamp_stops", f64::from(light.lamp_stops), 0.1, 16.0, "0.1 to 16 stops"),
        ] {
            if !(value >= least && value <= most) {
                return refuse(key, value.to_string(), wanted);
            }
        }
        if exposure.follow && self.exposure_us.is_none() {
            return refuse("exposure.follow", "true".to_owned(), "needs an exposure_us to start from");
        }
        Ok(())
    }
}
