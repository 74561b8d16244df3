//! Two ways of one hand: as the tracker had it, and as refinement has it, with how well each picture fits the surface.

use wire::{FrameFit, Trajectory};

const NOT_KNOWN: [u8; 3] = [150, 150, 150];
/// A picture that is so far off the surface is as red as can be.
const WORST_M: f32 = 3e-4;

/// What has come of one scan.
#[derive(Debug, Default)]
pub struct Ways {
    scan: u64,
    revision: u32,
    tracker: Vec<[f32; 3]>,
    /// Stamp and place, of the newest revision.
    refined: Vec<(i64, [f32; 3])>,
}

impl Ways {
    /// Takes a piece of the tracker's own way; its last sample is enough to draw.
    pub fn tracker(&mut self, way: &Trajectory) {
        self.begin(way.header.scan);
        self.tracker.extend(way.samples.last().map(|sample| sample.translation_m.map(|t| t as f32)));
    }

    /// Takes a piece of the refined way, or all of it. Revision 0 is the tracker's own, relayed, and is passed over; a
    /// higher one starts afresh.
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

    /// The tracker's way so far, in the world.
    pub fn by_tracker(&self) -> &[[f32; 3]] {
        &self.tracker
    }

    /// The refined way, of its samples every `one_in`th.
    pub fn by_refinement(&self, one_in: usize) -> Vec<[f32; 3]> {
        self.refined.iter().step_by(one_in.max(1)).map(|(_, place)| *place).collect()
    }

    /// Where each picture was taken, green when it fits the surface and red when it does not; those beyond the refined
    /// way are left out.
    pub fn pictures(&self, fits: &[FrameFit]) -> Vec<([f32; 3], [u8; 3])> {
        let at = |fit: &FrameFit| {
            let after = self.refined.partition_point(|(stamp, _)| *stamp < fit.stamp_nanos);
            Some((self.refined.get(after)?.1, by_residual(fit.residual_m)))
        };
        fits.iter().filter_map(at).collect()
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
