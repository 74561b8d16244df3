//! The least-squares Gaussian, without exponentials for each pixel.
//!
//! The iteratively Gaussian-weighted centroid (Baker and Moallem, Opt. Express 15, 5147, 2007), its weight matched to the
//! line's own width by adaptive moments (Bernstein and Jarvis, AJ 123, 583, 2002). With the matched width it is the
//! least-squares fit, and its variance the Cramer-Rao bound (Winick, JOSA A 3, 1809, 1986).

use crate::config::Config;
use crate::flanks::Flanks;
use crate::measure::Peak;
use crate::refusal::Reason;
use crate::window::{Background, Window};
use std::f32::consts::{PI, TAU};

/// Beyond so many standard deviations the line adds nothing to the fit.
const FIT_SIGMAS: f32 = 3.0;
/// Between the fit and the background.
pub(crate) const CLEAR_PX: f32 = 1.5;
/// A narrower weight would see too few pixels for its moments to be those of a Gaussian.
const LEAST_WEIGHT_PX: f32 = 1.2;
/// Steps that are enough.
pub(crate) const ITERATIONS: usize = 4;
/// After a step so short the next would be a tenth of it, far below any sigma.
const STEP_PX: f32 = 1e-2;

/// A line that is not clipped, while it is fitted. Places are pixels of the window.
#[derive(Debug)]
pub(crate) struct Fit {
    /// Where it began.
    start: f32,
    /// Where it is.
    x: f32,
    /// The right flank.
    right: f32,
    /// Standard deviations of the line, and of its weight in the last step.
    line: f32,
    weight: f32,
    /// Weighted sum above the background, and the variance of that background's slope.
    sum: f32,
    slope_variance: f32,
}

impl Fit {
    #[inline(always)]
    pub(crate) fn new(flanks: &Flanks, config: &Config) -> Self {
        let x = flanks.middle();
        let line = flanks.width().max(config.min_width_px);
        Self { start: x, x, right: flanks.right, line, weight: line, sum: 0.0, slope_variance: 0.0 }
    }

    /// One iteration; true when the next would change nothing.
    #[inline(always)]
    pub(crate) fn step(&mut self, window: &Window, config: &Config) -> Result<bool, Reason> {
        let weight = self.line.max(LEAST_WEIGHT_PX);
        let background = window.background(self.x, FIT_SIGMAS * weight + CLEAR_PX).ok_or(window.outside())?;
        let [sum, first, second] = weighted_moments(window, self.x, weight, &background);
        let (mean, spread) = (first / sum, second / sum - (first / sum).powi(2));
        if !(sum > 0.0 && spread.is_finite()) {
            return Err(Reason::Shapeless);
        }
        if spread <= 0.0 {
            return Err(Reason::Narrow);
        }
        // The product of line and weight has 1/spread = 1/line^2 + 1/weight^2, and its mean is the line's, shrunk alike.
        let square = 1.0 / (1.0 / spread - 1.0 / weight.powi(2)).max(0.4 / weight.powi(2));
        let step = mean * (square + weight.powi(2)) / weight.powi(2);
        self.x += step;
        self.line = square.sqrt().clamp(0.6 * self.line, 1.5 * self.line);
        (self.weight, self.sum, self.slope_variance) = (weight, sum, background.slope_variance);
        if (self.x - self.start).abs() > self.line + 1.0 {
            return Err(Reason::Shapeless);
        }
        Ok(step.abs() < STEP_PX || self.line > 1.5 * config.max_width_px)
    }

    /// After at least one step; `sigma` is the noise of a pixel.
    #[inline(always)]
    pub(crate) fn peak(&self, sigma: f32) -> Peak {
        let &Self { x, line, weight, sum, .. } = self;
        let both = line * line + weight * weight;
        let amplitude = sum * (both / TAU).sqrt() / (line * weight);
        // All from x = sum y t g / sum y g, times both / weight^2; with equal widths the first is 2 w / (sqrt(pi) A^2).
        let pixel = both.powi(3) / (4.0 * PI.sqrt() * amplitude.powi(2) * line.powi(2) * weight.powi(3));
        let slope = both.powi(3) / (amplitude * line).powi(2) * self.slope_variance;
        Peak {
            position: x,
            amplitude,
            width: line,
            noise_variance: sigma * sigma * (pixel + slope),
            speckle_variance: line * both.powf(1.5) / (4.0 * PI.sqrt() * weight.powi(3)),
            clipped: false,
            ends: self.right.max(x),
        }
    }
}

/// Sum, first and second moment about `x` of the line times a Gaussian weight of standard deviation `w`. The weights of
/// neighbouring pixels differ by a factor that itself falls by a constant factor, so three exponentials make them all.
#[inline(always)]
fn weighted_moments(window: &Window, x: f32, w: f32, background: &Background) -> [f32; 3] {
    let last = window.samples.len() - 1;
    let from = (x - FIT_SIGMAS * w).ceil().max(0.0) as usize;
    let to = ((x + FIT_SIGMAS * w).floor().max(0.0) as usize).min(last);
    let scale = 0.5 / (w * w);
    let mut t = from as f32 - x;
    let mut weight = (-t * t * scale).exp();
    let mut ratio = (-(2.0 * t + 1.0) * scale).exp();
    let fall = (-2.0 * scale).exp();
    let mut moments = [0.0; 3];
    for sample in &window.samples[from.min(to)..=to] {
        let light = weight * (sample.grey - background.level - background.slope * t);
        moments[0] += light;
        moments[1] += light * t;
        moments[2] += light * t * t;
        weight *= ratio;
        ratio *= fall;
        t += 1.0;
    }
    moments
}
