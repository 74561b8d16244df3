//! What the operator can set.

use serde::{Deserialize, Serialize};

/// `[cluster]` in a launch file.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// D of the paper: the radius of a ball. Points of a ball are averaged, so it should be no smaller than the noise and
    /// no larger than the finest detail that is to survive. Default 0.0008.
    pub ball_radius_m: f64,
    /// While poses are known badly, balls are larger: D is at least so many times what the pose's standard deviation, as the
    /// first scan (or the first of a revision) states it, moves its first point. 0: never. Default 2.
    pub radius_per_sigma: f64,
    /// T of the paper: a ball with fewer points is an outlier. Default 4.
    pub least_points: u32,
    /// Whether the table on which the thing stands is taken away at the end. Default `keep`.
    pub table: Table,
    /// Seconds of the scan between two messages of what changed. Default 0.5.
    pub publish_every_s: f64,
}

/// What becomes of the largest plane (see [`geometry::Table`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Table {
    /// It is part of the scan.
    #[default]
    Keep,
    /// It and what lies behind it is taken away.
    Remove,
}

impl Default for Config {
    fn default() -> Self {
        Self { ball_radius_m: 0.8e-3, radius_per_sigma: 2.0, least_points: 4, table: Table::Keep, publish_every_s: 0.5 }
    }
}

/// A configuration that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// Too small, too large or NaN.
    #[error("ball_radius_m = {0}: from 0.00001 to 0.1 is understood")]
    BallRadius(f64),
    /// Below 0, too large or NaN.
    #[error("radius_per_sigma = {0}: from 0 to 100 is understood")]
    RadiusPerSigma(f64),
    /// Then every ball would be an outlier, or none could be.
    #[error("least_points = 0: a ball has at least the point that founded it; say 1 to keep them all")]
    LeastPoints,
    /// Never, or for ever.
    #[error("publish_every_s = {0}: from 0.01 to 3600 is understood")]
    PublishEvery(f64),
}

impl Config {
    /// Refuses what cannot work.
    pub fn check(&self) -> Result<(), ConfigError> {
        if !(1e-5..=0.1).contains(&self.ball_radius_m) {
            return Err(ConfigError::BallRadius(self.ball_radius_m));
        }
        if !(0.0..=100.0).contains(&self.radius_per_sigma) {
            return Err(ConfigError::RadiusPerSigma(self.radius_per_sigma));
        }
        if self.least_points == 0 {
            return Err(ConfigError::LeastPoints);
        }
        if !(0.01..=3600.0).contains(&self.publish_every_s) {
            return Err(ConfigError::PublishEvery(self.publish_every_s));
        }
        Ok(())
    }
}
