//! A picture in, its stripe out.

use crate::channel::LaserChannel;
use crate::lateral::{Averaging, Lateral, LinePeak};
use crate::measure::{Peak, measure};
use crate::refusal::{Reason, Refusals};
use crate::search::{Run, Search};
use crate::window::Window;
use crate::{Config, ConfigError, noise, support};
use wire::{Frame, FrameError, LaserPlane, PeaksPer, Stripe, StripePeak};

/// Around a stretch that stands out; enough for lines up to about 2 px wide, wider ones are read again.
const REACH_PX: usize = 14;

/// No position is known better: the pixels of a sensor are not more even, nor is a line more like a Gaussian.
const EVENNESS_PX: f32 = 0.01;

/// Finds the laser line in pictures of one rig. It keeps its buffers: in the long run nothing is allocated but the result.
#[derive(Debug)]
pub struct StripeDetector {
    config: Config,
    channel: LaserChannel,
    peaks_per: PeaksPer,
    search: Search,
    row: Vec<u8>,
    window: Window,
    peaks: Vec<LinePeak>,
    support: Vec<u8>,
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
            row: Vec::new(),
            window: Window::default(),
            peaks: Vec::new(),
            support: Vec::new(),
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
            self.refuse_the_lonely(&mut refusals);
            // After the grains, which must not push the line out of a row.
            self.refuse_the_small(&mut refusals);
            self.mark_the_best();
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
        let mut next = 0;
        while let Some(&Run { line, .. }) = self.search.runs.get(next) {
            let count = self.search.runs[next..].iter().take_while(|run| run.line == line).count();
            self.line(frame, next..next + count, sigma, refusals);
            next += count;
        }
    }

    /// The peaks of one line.
    fn line(&mut self, frame: &Frame, runs: std::ops::Range<usize>, sigma: f32, refusals: &mut Refusals) {
        // What stands out beside a clipped core, or in a ragged flank, belongs to the peak before it.
        let mut taken_to = f32::NEG_INFINITY;
        for at in runs {
            let run = self.search.runs[at];
            if (run.first as f32) < taken_to {
                continue;
            }
            match self.peak(frame, run, sigma) {
                Ok(peak) if peak.position < taken_to => {}
                Ok(peak) => {
                    taken_to = peak.ends;
                    self.peaks.push(LinePeak { line: run.line, best: false, peak });
                }
                Err(reason) => refusals.count(reason),
            }
        }
    }

    /// Leaves out what no line goes on from.
    fn refuse_the_lonely(&mut self, refusals: &mut Refusals) {
        support::count(&self.peaks, self.config.link_px, &mut self.support);
        let mut support = self.support.iter();
        self.peaks.retain(|_| {
            let holds = support.next().is_some_and(|lines| usize::from(*lines) >= self.config.min_support_lines);
            if !holds {
                refusals.count(Reason::Alone);
            }
            holds
        });
    }

    /// Keeps the largest of each line.
    fn refuse_the_small(&mut self, refusals: &mut Refusals) {
        let mut start = 0;
        while let Some(&LinePeak { line, .. }) = self.peaks.get(start) {
            let mut end = start + self.peaks[start..].iter().take_while(|peak| peak.line == line).count();
            while end - start > self.config.max_peaks_per_line {
                let smallest = (start..end)
                    .min_by(|&a, &b| self.peaks[a].peak.amplitude.total_cmp(&self.peaks[b].peak.amplitude))
                    .unwrap_or(start);
                self.peaks.remove(smallest);
                refusals.count(Reason::Crowded);
                end -= 1;
            }
            start = end;
        }
    }

    /// The largest of each line is its best.
    fn mark_the_best(&mut self) {
        for peaks in self.peaks.chunk_by_mut(|a, b| a.line == b.line) {
            let Some(Peak { amplitude, clipped, .. }) =
                peaks.iter().map(|p| p.peak).max_by(|a, b| a.amplitude.total_cmp(&b.amplitude))
            else {
                continue;
            };
            let enough = (1.0 - self.config.tie_fraction) * amplitude;
            // How high a clipped peak really is, nobody knows.
            let ties = |peak: &Peak| peak.amplitude >= enough || (peak.clipped && clipped);
            if let Some(best) = peaks.iter_mut().find(|p| ties(&p.peak)) {
                best.best = true;
            }
        }
    }

    /// One peak; a window that proves too small is read again as large as the widest line needs.
    fn peak(&mut self, frame: &Frame, mut run: Run, sigma: f32) -> Result<Peak, Reason> {
        let widest = (4.0 * self.config.max_width_px) as usize + REACH_PX;
        let mut result = Err(Reason::Shapeless);
        for reach in [REACH_PX + (run.last - run.first) as usize, widest] {
            self.window.read(&self.channel, frame, self.peaks_per, run, reach);
            run.last = self.window.clipped_to(run.last);
            result = measure(&self.window, run, sigma, &self.config);
            if result != Err(Reason::Wide) {
                break;
            }
        }
        result
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
