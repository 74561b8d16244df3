//! Exposure that follows the stripe.

use crate::exposure::{ExposureConfig, Setting, StripeStatistics, next_setting};
use wire::Stripe;

/// Waits until a change shows before it makes the next.
#[derive(Debug, Clone)]
pub struct ExposureLoop {
    config: ExposureConfig,
    gamma: f32,
    settle_nanos: i64,
    settled_nanos: i64,
}

impl ExposureLoop {
    /// A loop for a camera of this gamma and rate.
    pub fn new(config: ExposureConfig, gamma: f32, rate_hz: f64) -> Self {
        let settle_nanos = (f64::from(config.settle_frames) / rate_hz * 1e9) as i64;
        Self { config, gamma, settle_nanos, settled_nanos: i64::MIN }
    }

    /// Looks at a stripe that was exposed with the setting `now`; what to set, when it should change.
    pub fn see(&mut self, stripe: &Stripe, now: Setting) -> Option<Setting> {
        let lit = stripe.light.laser && !stripe.light.lamp;
        if !self.config.follow || !lit || stripe.header.is_end() || stripe.header.stamp_nanos < self.settled_nanos {
            return None;
        }
        let next = next_setting(&self.config, now, &StripeStatistics::of(stripe), self.gamma);
        if next == now {
            return None;
        }
        self.settled_nanos = stripe.header.stamp_nanos + self.settle_nanos;
        Some(next)
    }
}
