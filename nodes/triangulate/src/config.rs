//! Which points are believed.

use serde::{Deserialize, Serialize};

/// The gates. Millimetres and degrees, because people write them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Points nearer along the optical axis are refused.
    pub near_mm: f64,
    /// Points farther along the optical axis are refused.
    pub far_mm: f64,
    /// Rays that meet the sheet at a smaller angle are refused.
    pub least_angle_deg: f64,
    /// Points that are less certain along the ray are refused.
    pub most_range_sigma_mm: f64,
    /// Take only the chosen peak of each row or column; otherwise all of them.
    pub best_only: bool,
    /// Refuse points whose peaks are clipped.
    pub refuse_saturated: bool,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            near_mm: 50.0,
            far_mm: 2000.0,
            least_angle_deg: 5.0,
            most_range_sigma_mm: 2.0,
            best_only: true,
            refuse_saturated: false,
        }
    }
}

/// A gate that nothing can pass.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("triangulate: {key} = {value}: {wanted}")]
pub struct ConfigError {
    /// The key.
    pub key: &'static str,
    /// What it holds.
    pub value: f64,
    /// What it should hold.
    pub wanted: &'static str,
}

impl Config {
    /// Refuses what makes no sense.
    pub fn check(&self) -> Result<(), ConfigError> {
        let refuse = |key, value, wanted| Err(ConfigError { key, value, wanted });
        if !(self.near_mm >= 0.0 && self.near_mm.is_finite()) {
            return refuse("near_mm", self.near_mm, "0 or more");
        }
        if !(self.far_mm > self.near_mm && self.far_mm.is_finite()) {
            return refuse("far_mm", self.far_mm, "more than near_mm");
        }
        if !(0.1..90.0).contains(&self.least_angle_deg) {
            return refuse("least_angle_deg", self.least_angle_deg, "0.1 to 90 degrees");
        }
        if self.most_range_sigma_mm.is_nan() || self.most_range_sigma_mm <= 0.0 {
            return refuse("most_range_sigma_mm", self.most_range_sigma_mm, "more than 0");
        }
        Ok(())
    }
}
