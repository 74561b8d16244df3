//! Which light is on, when.

use crate::config::Config;
use std::time::Duration;
use wire::{Light, Phase};

/// Both are off.
pub const DARK: Light = Light { laser: false, lamp: false };

/// Which light is on in a phase that began so long ago. In `both` the laser and the lamp take turns, the laser first.
///
/// ```
/// use light::{Config, lit};
/// use std::time::Duration;
/// use wire::Phase;
/// let config = Config { laser_ms: 500, lamp_ms: 100, ..Config::default() };
/// assert!(lit(&config, Phase::Both, Duration::from_millis(1099)).laser);
/// assert!(lit(&config, Phase::Both, Duration::from_millis(1100)).lamp);
/// ```
pub fn lit(config: &Config, phase: Phase, since: Duration) -> Light {
    let laser = Light { laser: true, lamp: false };
    let lamp = Light { laser: false, lamp: true };
    match phase {
        Phase::Aim if config.aim_with_laser => laser,
        Phase::Aim | Phase::End => DARK,
        Phase::Shape => laser,
        Phase::Colour => lamp,
        Phase::Both => {
            let turn = u128::from(config.laser_ms) + u128::from(config.lamp_ms);
            if since.as_millis() % turn.max(1) < u128::from(config.laser_ms) { laser } else { lamp }
        }
    }
}
