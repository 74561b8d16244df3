//! One peak, to a fraction of a pixel, with its variance.

use crate::config::Config;
use crate::flanks::{find_flanks, plateau};
use crate::gaussian::Fit;
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

/// What stands out, on its way to a peak. It goes in steps, so that many go side by side: each step waits for the one
/// before, and the processor has others to do meanwhile.
#[derive(Debug)]
pub(crate) struct Candidate {
    pub run: Run,
    pub window: Window,
    fit: Option<Fit>,
    /// As long as the window is too small, `Wide`.
    pub result: Result<Peak, Reason>,
}

impl Default for Candidate {
    fn default() -> Self {
        let run = Run { line: 0, first: 0, last: 0 };
        Self { run, window: Window::default(), fit: None, result: Err(Reason::Wide) }
    }
}

impl Candidate {
    /// Something else that stands out; its window is not read yet.
    #[inline(always)]
    pub(crate) fn restart(&mut self, run: Run) {
        self.run = run;
        self.result = Err(Reason::Wide);
    }

    /// Looks at the window, which holds the pixels of the run; `sigma` is the noise of a pixel in grey levels.
    #[inline(always)]
    pub(crate) fn start(&mut self, sigma: f32, config: &Config) {
        self.run.last = self.window.clipped_to(self.run.last);
        let (window, samples) = (&self.window, &self.window.samples);
        self.fit = None;
        self.result = Err(window.outside());
        let (from, to) = (self.run.first as usize - window.first, self.run.last as usize - window.first);
        let top = (from..=to).fold(from, |best, i| if samples[i].grey > samples[best].grey { i } else { best });
        let Some(flanks) = find_flanks(window, top) else { return };
        if flanks.width() > config.max_width_px {
            self.result = Err(Reason::Wide);
            return;
        }
        let (left, right) = (flanks.left.max(0.0) as usize, (flanks.right.ceil() as usize).min(samples.len() - 1));
        if !samples[left..=right].iter().any(|s| s.clipped) {
            self.fit = Some(Fit::new(&flanks, config));
        } else if let Some(peak) = plateau(window, &flanks, samples[top].grey, sigma) {
            self.result = judge(peak, window, sigma, config);
        }
    }

    /// Brings the fit, if there is one, a step nearer.
    #[inline(always)]
    pub(crate) fn step(&mut self, sigma: f32, config: &Config) {
        let Some(fit) = &mut self.fit else { return };
        match fit.step(&self.window, config) {
            Ok(false) => {}
            Ok(true) => self.settle(sigma, config),
            Err(reason) => {
                self.fit = None;
                self.result = Err(reason);
            }
        }
    }

    /// Takes the fit, if there is one, as it is.
    #[inline(always)]
    pub(crate) fn settle(&mut self, sigma: f32, config: &Config) {
        if let Some(fit) = self.fit.take() {
            self.result = judge(fit.peak(sigma), &self.window, sigma, config);
        }
    }
}

/// A peak of the window, as one of the picture; or why it is none.
#[inline(always)]
fn judge(mut peak: Peak, window: &Window, sigma: f32, config: &Config) -> Result<Peak, Reason> {
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
