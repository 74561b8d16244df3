//! One peak, to a fraction of a pixel, with its variance.

use crate::config::Config;
use crate::flanks::{find_flanks, plateau};
use crate::gaussian::gaussian;
use crate::refusal::Reason;
use crate::search::Run;
use crate::window::Window;

/// A peak, on its line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Peak {
    /// Position on the line, in pixels of the picture.
    pub position: f32,
    /// Above the background.
    pub amplitude: f32,
    /// Standard deviation of the profile.
    pub width: f32,
    /// Variance of the position by the noise of the pixels.
    pub noise_variance: f32,
    /// Variance of the position by multiplicative noise (speckle) of contrast 1, white from pixel to pixel.
    pub speckle_variance: f32,
    /// Its top is clipped.
    pub clipped: bool,
    /// Where its right (or lower) flank ends: what stands out before belongs to it.
    pub ends: f32,
}

/// Measures what stands out in `run`, whose pixels the window holds; `sigma` is the noise of a pixel in grey levels.
#[inline(always)]
pub(crate) fn measure(window: &Window, run: Run, sigma: f32, config: &Config) -> Result<Peak, Reason> {
    let samples = &window.samples;
    let (from, to) = (run.first as usize - window.first, run.last as usize - window.first);
    let top = (from..=to).fold(from, |best, i| if samples[i].grey > samples[best].grey { i } else { best });
    let outside = if window.cut { Reason::Edge } else { Reason::Wide };
    let flanks = find_flanks(window, top).ok_or(outside)?;
    if flanks.width() > config.max_width_px {
        return Err(Reason::Wide);
    }
    let (left, right) = (flanks.left.max(0.0) as usize, (flanks.right.ceil() as usize).min(samples.len() - 1));
    let mut peak = if samples[left..=right].iter().any(|s| s.clipped) {
        plateau(window, &flanks, samples[top].grey, sigma).ok_or(outside)?
    } else {
        gaussian(window, &flanks, sigma, config)?.ok_or(outside)?
    };
    if peak.width > config.max_width_px {
        return Err(Reason::Wide);
    }
    if peak.width < config.min_width_px {
        return Err(Reason::Narrow);
    }
    if peak.amplitude < config.min_amplitude.max(config.min_noise_ratio * sigma) {
        return Err(Reason::Faint);
    }
    peak.position += window.first as f32;
    peak.ends += window.first as f32;
    Ok(peak)
}
