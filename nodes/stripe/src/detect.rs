//! A picture in, its stripe out.

use crate::batch::{Measure, Measuring, RUNS};
use crate::channel::LaserChannel;
use crate::choice::Choice;
use crate::lateral::{Averaging, Lateral, LinePeak};
use crate::lonely::Lonely;
use crate::measure::Candidate;
use crate::refusal::Refusals;
use crate::search::Search;
use crate::{Config, ConfigError, noise};
use wire::{Frame, FrameError, LaserPlane, PeaksPer, Stripe, StripePeak};

/// No position is known better: the pixels of a sensor are not more even, nor is a line more like a Gaussian.
const EVENNESS_PX: f32 = 0.01;

/// Finds the laser line in pictures of one rig. It keeps its buffers: in the long run nothing is allocated but the result.
#[derive(Debug)]
pub struct StripeDetector {
    config: Config,
    channel: LaserChannel,
    peaks_per: PeaksPer,
    search: Search,
    lonely: Lonely,
    row: Vec<u8>,
    candidates: Vec<Candidate>,
    peaks: Vec<LinePeak>,
    choice: Choice,
    lateral: Lateral,
}

impl StripeDetector {
    /// A detector for this laser: of the plane only its channel weights and the direction of its stripe are used.
    ///
    /// # Errors
    /// A configuration outside its ranges, or weights that no laser can have.
    pub fn new(config: Config, laser: &LaserPlane) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self {
            channel: LaserChannel::new(laser.channel_weights, config.saturation_level)?,
            peaks_per: laser.peaks_per,
            search: Search::new(config.max_width_px),
            lonely: Lonely::default(),
            row: Vec::new(),
            candidates: Vec::new(),
            peaks: Vec::new(),
            choice: Choice::default(),
            lateral: Lateral::default(),
            config,
        })
    }

    /// All peaks of the picture. Without the laser there are none, and no pixel is looked at.
    ///
    /// # Errors
    /// A frame whose bytes contradict its header.
    pub fn process(&mut self, frame: &Frame) -> Result<Stripe, FrameError> {
        let mut refusals = Refusals::default();
        self.peaks.clear();
        if frame.light.laser {
            frame.check()?;
            self.find(frame, &mut refusals);
            self.choice.choose(&mut self.peaks, &self.config, &mut refusals);
            let Config { lateral_lines: lines, link_px, speckle_contrast: contrast, .. } = self.config;
            self.lateral.average(&mut self.peaks, Averaging { lines, link_px, contrast });
            // Averages of neighbours that are hardly apart may have changed places.
            let place = |p: &LinePeak| (p.line, p.peak.position);
            self.peaks.sort_unstable_by(|a, b| {
                let ((a, x), (b, y)) = (place(a), place(b));
                a.cmp(&b).then(x.total_cmp(&y))
            });
        }
        Ok(Stripe {
            header: frame.header.derived(),
            width: frame.width,
            height: frame.height,
            light: frame.light,
            peaks: self.peaks.iter().map(|peak| self.to_wire(peak)).collect(),
            refused: refusals.to_wire(),
        })
    }

    /// Both passes: over all pixels for what stands out, then to a fraction of a pixel there.
    fn find(&mut self, frame: &Frame, refusals: &mut Refusals) {
        let levels = self.channel.levels(frame.format);
        self.row.resize(frame.width as usize, 0);
        let noise_levels = noise::sigma_levels(self.search.arch, frame, &levels, &mut self.row);
        let sigma = (noise_levels / levels.per_grey).max(self.config.noise_floor);
        let height = self.config.min_amplitude.max(self.config.min_noise_ratio * sigma);
        let threshold = (height * levels.per_grey).clamp(1.0, 254.0) as u8;
        self.search.run(frame, &levels, self.peaks_per, threshold);
        let size = match self.peaks_per {
            PeaksPer::Row => [frame.height, frame.width],
            PeaksPer::Column => [frame.width, frame.height],
        };
        self.lonely.refuse(&mut self.search.runs, size, &self.config, refusals);
        let mut measuring = Measuring {
            config: &self.config,
            channel: &self.channel,
            frame,
            peaks_per: self.peaks_per,
            sigma,
            candidates: &mut self.candidates,
            peaks: &mut self.peaks,
            refusals,
            taken_to: (0, f32::NEG_INFINITY),
        };
        for runs in self.search.runs.chunks(RUNS) {
            self.search.arch.dispatch(Measure { measuring: &mut measuring, runs });
        }
    }

    fn to_wire(&self, found: &LinePeak) -> StripePeak {
        let LinePeak { line, best, ref peak } = *found;
        let line = line as f32;
        let (u_px, v_px) = match self.peaks_per {
            PeaksPer::Row => (peak.position, line),
            PeaksPer::Column => (line, peak.position),
        };
        let best = if best { StripePeak::BEST } else { 0 };
        let clipped = if peak.clipped { StripePeak::SATURATED } else { 0 };
        StripePeak {
            u_px,
            v_px,
            sigma_px: peak.noise_variance.sqrt().hypot(EVENNESS_PX),
            amplitude: peak.amplitude,
            width_px: peak.width,
            flags: best | clipped,
        }
    }
}
