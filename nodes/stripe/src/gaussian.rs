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
const ITERATIONS: usize = 4;
/// After a step so short the next would be a tenth of it, far below any sigma.
const STEP_PX: f32 = 1e-2;

/// A line that is not clipped. `Ok(None)` when the window ends before the background.
#[inline(always)]
pub(crate) fn gaussian(window: &Window, flanks: &Flanks, sigma: f32, config: &Config) -> Result<Option<Peak>, Reason> {
    let start = flanks.middle();
    let (mut x, mut line) = (start, flanks.width().max(config.min_width_px));
    let mut last = None;
    for _ in 0..ITERATIONS {
        let weight = line.max(LEAST_WEIGHT_PX);
        let Some(background) = window.background(x, FIT_SIGMAS * weight + CLEAR_PX) else { return Ok(None) };
        let [sum, first, second] = weighted_moments(window, x, weight, &background);
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
        x += step;
        line = square.sqrt().clamp(0.6 * line, 1.5 * line);
        last = Some((sum, weight, background));
        if (x - start).abs() > line + 1.0 {
            return Err(Reason::Shapeless);
        }
        if step.abs() < STEP_PX || line > 1.5 * config.max_width_px {
            break;
        }
    }
    Ok(last.map(|(sum, weight, background)| {
        let both = line * line + weight * weight;
        let amplitude = sum * (both / TAU).sqrt() / (line * weight);
        // All from x = sum y t g / sum y g, times both / weight^2; with equal widths the first is 2 w / (sqrt(pi) A^2).
        let pixel = both.powi(3) / (4.0 * PI.sqrt() * amplitude.powi(2) * line.powi(2) * weight.powi(3));
        let slope = both.powi(3) / (amplitude * line).powi(2) * background.slope_variance;
        Peak {
            position: x,
            amplitude,
            width: line,
            noise_variance: sigma * sigma * (pixel + slope),
            speckle_variance: line * both.powf(1.5) / (4.0 * PI.sqrt() * weight.powi(3)),
            clipped: false,
            ends: flanks.right.max(x),
        }
    }))
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
