//! Two ways of one hand: as the tracker had it, and as refinement has it, with how well each picture fits the surface.

use rerun::{LineStrips3D, Points3D, RecordingStream};
use wire::{FrameFit, Refinement, Trajectory};

type Result = rerun::RecordingStreamResult<()>;

const TRACKER: [u8; 3] = [90, 150, 220];
const REFINED: [u8; 3] = [70, 190, 110];
const NOT_KNOWN: [u8; 3] = [150, 150, 150];
/// A picture that is so far off the surface is as red as can be.
const WORST_M: f32 = 3e-4;
/// Of the samples, which are as dense as the hand trembles.
const DRAWN_EVERY: usize = 10;

/// What has come of one scan.
#[derive(Debug, Default)]
pub(crate) struct Ways {
    scan: u64,
    revision: u32,
    tracker: Vec<[f32; 3]>,
    /// Stamp and place, of the newest revision.
    refined: Vec<(i64, [f32; 3])>,
}

impl Ways {
    pub fn tracker(&mut self, way: &Trajectory) {
        self.begin(way.header.scan);
        self.tracker.extend(way.samples.last().map(|sample| sample.translation_m.map(|t| t as f32)));
    }

    /// Revision 0 is the tracker's own way, relayed.
    pub fn refined(&mut self, way: &Trajectory) {
        self.begin(way.header.scan);
        if way.header.revision == 0 || way.samples.is_empty() {
            return;
        }
        if way.header.revision > self.revision {
            self.revision = way.header.revision;
            self.refined.clear();
        }
        let placed = way.samples.iter().map(|sample| (sample.stamp_nanos, sample.translation_m.map(|t| t as f32)));
        self.refined.extend(placed);
    }

    fn begin(&mut self, scan: u64) {
        if scan > self.scan {
            *self = Self { scan, ..Self::default() };
        }
    }

    pub fn show(&self, rec: &RecordingStream, evidence: &Refinement) -> Result {
        let line = |places: Vec<[f32; 3]>, colour| LineStrips3D::new([places]).with_colors([colour]).with_radii([4e-4]);
        rec.log("way/tracker", &line(self.tracker.clone(), TRACKER))?;
        rec.log("way/refined", &line(self.refined.iter().step_by(DRAWN_EVERY).map(|s| s.1).collect(), REFINED))?;
        let at = |fit: &FrameFit| {
            let after = self.refined.partition_point(|(stamp, _)| *stamp < fit.stamp_nanos);
            Some((self.refined.get(after)?.1, by_residual(fit.residual_m)))
        };
        let (places, colours): (Vec<_>, Vec<_>) = evidence.frames.iter().filter_map(at).unzip();
        rec.log("way/pictures", &Points3D::new(places).with_colors(colours).with_radii([1.2e-3]))
    }
}

/// Green fits, red does not.
fn by_residual(residual_m: f32) -> [u8; 3] {
    if residual_m.is_nan() {
        return NOT_KNOWN;
    }
    let bad = (residual_m / WORST_M).clamp(0.0, 1.0);
    [(60.0 + 170.0 * bad) as u8, (190.0 - 130.0 * bad) as u8, 70]
}
