//! What the operator may set.

use serde::{Deserialize, Serialize};

/// How peaks are found and judged. Grey levels are those of the laser channel: the weighted sum of red, green and blue.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Height above the background on both sides that a peak needs, in grey levels.
    pub min_amplitude: f32,
    /// The same in standard deviations of the picture's noise; the larger of both counts.
    pub min_noise_ratio: f32,
    /// The noise of a pixel is never taken to be less, in grey levels (8 bits alone make 0.3).
    pub noise_floor: f32,
    /// A peak narrower than this is a hot pixel (standard deviation; the width at half height is 2.35 times as much).
    pub min_width_px: f32,
    /// A peak wider than this is a lit area, not a line. Also the reach of the search for a background.
    pub max_width_px: f32,
    /// From this value on a channel is clipped.
    pub saturation_level: u8,
    /// In each row or column the largest are kept.
    pub max_peaks_per_line: usize,
    /// Amplitudes that differ by less than this fraction of the largest are a tie (as are all that are clipped), and the
    /// first of them is the best.
    pub tie_fraction: f32,
    /// A position is averaged with as many neighbours along the stripe on either side; 0 averages nothing.
    pub lateral_lines: usize,
    /// A neighbour along the stripe lies at most so far aside in the next row or column.
    pub link_px: f32,
    /// Of the four rows or columns on either side of a peak at least so many hold the line, too; 0 asks for none. Grains of
    /// noise and texture stand alone.
    pub min_support_lines: usize,
    /// Contrast of the speckle, for a stripe too short to tell it from its own scatter.
    pub speckle_contrast: f32,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            min_amplitude: 12.0,
            min_noise_ratio: 4.0,
            noise_floor: 0.5,
            min_width_px: 0.4,
            max_width_px: 16.0,
            saturation_level: 252,
            max_peaks_per_line: 8,
            tie_fraction: 0.05,
            lateral_lines: 3,
            link_px: 3.0,
            min_support_lines: 4,
            speckle_contrast: 0.1,
        }
    }
}

/// What cannot work.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// A number outside its range.
    #[error("[stripe] {name} = {value}: {wanted}")]
    Value {
        /// The key.
        name: &'static str,
        /// What it holds.
        value: f64,
        /// What it should hold.
        wanted: &'static str,
    },
    /// The rig's channels.
    #[error("[laser] channel_weights = {0:?}: finite, at most 16 either way, and at least one above 0")]
    Weights([f64; 3]),
}

impl Config {
    /// Refuses what cannot work.
    pub fn check(&self) -> Result<(), ConfigError> {
        let wanted = |good: bool, name, value: f64, wanted| {
            if good { Ok(()) } else { Err(ConfigError::Value { name, value, wanted }) }
        };
        let within = |name, value: f32, low: f32, high: f32, text| {
            wanted((low..=high).contains(&value), name, f64::from(value), text)
        };
        within("min_amplitude", self.min_amplitude, 1.0, 1000.0, "1 to 1000 grey levels")?;
        within("min_noise_ratio", self.min_noise_ratio, 1.0, 100.0, "1 to 100 standard deviations")?;
        within("noise_floor", self.noise_floor, 0.1, 100.0, "0.1 to 100 grey levels")?;
        within("min_width_px", self.min_width_px, 0.2, 10.0, "0.2 to 10 pixels")?;
        within("max_width_px", self.max_width_px, self.min_width_px, 30.0, "min_width_px to 30 pixels")?;
        within("tie_fraction", self.tie_fraction, 0.0, 1.0, "0 to 1")?;
        within("link_px", self.link_px, 0.0, 100.0, "0 to 100 pixels")?;
        within("speckle_contrast", self.speckle_contrast, 0.0, 1.0, "0 to 1")?;
        let peaks = self.max_peaks_per_line;
        wanted((1..=64).contains(&peaks), "max_peaks_per_line", peaks as f64, "1 to 64")?;
        let lines = self.lateral_lines;
        wanted(lines <= 16, "lateral_lines", lines as f64, "0 to 16 rows or columns")?;
        let support = self.min_support_lines;
        wanted(support <= 8, "min_support_lines", support as f64, "0 to 8 rows or columns")?;
        let level = self.saturation_level;
        wanted(level >= 32, "saturation_level", f64::from(level), "32 to 255")
    }
}
