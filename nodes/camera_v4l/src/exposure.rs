//! How long to expose, by what the stripe itself looks like.

use serde::{Deserialize, Serialize};
use wire::{Stripe, StripePeak};

/// What is wanted of the stripe, and how far the camera may be turned for it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ExposureConfig {
    /// Follow the stripe. Off: exposure and gain stay as they are configured.
    pub follow: bool,
    /// Height that the higher peaks (the upper tenth) should have, in grey levels of the laser channel.
    pub target_peak: f32,
    /// At most this share of the peaks may be clipped.
    pub most_saturated: f32,
    /// Nothing is changed while the peaks are this close to the target, as a factor.
    pub dead_band: f32,
    /// Fewer peaks say nothing about the light.
    pub least_peaks: usize,
    /// Shortest exposure.
    pub least_us: f64,
    /// Longest exposure: a hand moves 0.5 mm in 1 ms.
    pub most_us: f64,
    /// Highest gain, linear; it is raised only when the exposure is at its longest.
    pub most_gain: f64,
    /// Pictures until a change shows in the stripe.
    pub settle_frames: u32,
}

impl Default for ExposureConfig {
    fn default() -> Self {
        Self {
            follow: false,
            target_peak: 160.0,
            most_saturated: 0.02,
            dead_band: 1.15,
            least_peaks: 20,
            least_us: 100.0,
            most_us: 4000.0,
            most_gain: 4.0,
            settle_frames: 8,
        }
    }
}

/// What the camera is set to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// How long the shutter is open.
    pub exposure_us: f64,
    /// Linear, 1 = none.
    pub gain: f64,
}

/// What the stripe looks like.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StripeStatistics {
    /// Best peaks of their row or column.
    pub peaks: usize,
    /// The height that a tenth of them exceeds, in grey levels of the laser channel.
    pub high_amplitude: f32,
    /// How many of them are clipped, 0 to 1.
    pub saturated_share: f32,
}

impl StripeStatistics {
    /// Of the best peak of each row or column.
    pub fn of(stripe: &Stripe) -> Self {
        let mut heights: Vec<f32> =
            stripe.peaks.iter().filter(|p| p.is_best() && p.amplitude.is_finite()).map(|p| p.amplitude).collect();
        let clipped = stripe.peaks.iter().filter(|p| p.is_best() && p.flags & StripePeak::SATURATED != 0).count();
        if heights.is_empty() {
            return Self::default();
        }
        let peaks = heights.len();
        let (_, high, _) = heights.select_nth_unstable_by((peaks * 9 / 10).min(peaks - 1), f32::total_cmp);
        Self { peaks, high_amplitude: *high, saturated_share: clipped as f32 / peaks as f32 }
    }
}

/// One step is at most so large: brighter is tried with care, since what clips tells nothing of how much too bright it is.
const MOST_DARKER: f64 = 0.5;
const MOST_BRIGHTER: f64 = 1.6;
/// When peaks clip, this much less light is taken at least.
const CLIPPED: f64 = 0.7;
/// When there is no line at all, it may be too dark to be seen.
const UNSEEN: f64 = 1.15;

/// The setting to take next; the same one when all is well. A line that is not seen at all raises the light step by step;
/// one that is seen in too few rows changes nothing. `gamma` is the camera's: grey level = 255 (light)^(1/gamma).
///
/// ```
/// use camera_v4l::{ExposureConfig, Setting, StripeStatistics, next_setting};
/// let config = ExposureConfig { follow: true, ..ExposureConfig::default() };
/// let dark = StripeStatistics { peaks: 400, high_amplitude: 128.0, saturated_share: 0.0 };
/// let setting = next_setting(&config, Setting { exposure_us: 1000.0, gain: 1.0 }, &dark, 1.0);
/// assert!((setting.exposure_us - 1250.0).abs() < 0.01);
/// ```
pub fn next_setting(config: &ExposureConfig, now: Setting, seen: &StripeStatistics, gamma: f32) -> Setting {
    let factor = factor(config, seen, gamma);
    if factor == 1.0 {
        return now;
    }
    let light = now.exposure_us * now.gain * factor;
    // Light before gain, which amplifies the noise as well.
    let exposure_us = light.clamp(config.least_us, config.most_us);
    let gain = (light / exposure_us).clamp(1.0, config.most_gain.max(1.0));
    Setting { exposure_us, gain }
}

/// How much more light is wanted.
fn factor(config: &ExposureConfig, seen: &StripeStatistics, gamma: f32) -> f64 {
    if seen.peaks == 0 {
        return UNSEEN;
    }
    if seen.peaks < config.least_peaks || seen.high_amplitude.is_nan() || seen.high_amplitude <= 0.0 {
        return 1.0;
    }
    let wanted = f64::from(config.target_peak / seen.high_amplitude);
    let mut factor = wanted.powf(f64::from(gamma)).clamp(MOST_DARKER, MOST_BRIGHTER);
    if seen.saturated_share > config.most_saturated {
        factor = factor.min(CLIPPED);
    } else if wanted.max(1.0 / wanted) <= f64::from(config.dead_band) {
        factor = 1.0;
    }
    factor
}
