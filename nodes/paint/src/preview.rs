//! Colour that comes on while the hand still moves: the surface so far, under some of the pictures so far.

use crate::{Config, FrameStore, Painter, PainterError};
use geometry::TrajectoryBuffer;
use std::time::{Duration, Instant};
use wire::{Calibration, Mesh, Model};

/// The eye wants no finer cells than these while everything still changes.
const LEAST_CELL_MM: f64 = 1.0;

/// Paints live surfaces, coarsely and not too often, with a painter of its own.
pub(crate) struct Preview {
    painter: Painter,
    every: Duration,
    pictures: usize,
    told: Instant,
}

impl Preview {
    pub fn new(config: &Config, calibration: &Calibration) -> Result<Self, PainterError> {
        let coarse = Config { cell_mm: config.cell_mm.max(LEAST_CELL_MM), ..config.clone() };
        let (every, pictures) = (Duration::from_secs_f64(config.live_every_s), config.live_pictures);
        Ok(Self { painter: Painter::new(coarse, calibration)?, every, pictures, told: Instant::now() })
    }

    /// Whether it is time for the next.
    pub fn is_due(&self) -> bool {
        !self.every.is_zero() && self.told.elapsed() >= self.every
    }

    /// The surface, coloured by pictures spread over the scan so far, where they are known to have been taken. `None` when
    /// it cannot be painted, or no picture has its place yet: then the bare surface shows more.
    pub fn paint(&mut self, mesh: &Mesh, store: &FrameStore, way: &TrajectoryBuffer, gap_nanos: i64) -> Option<Model> {
        self.painter.mesh(mesh).ok()?;
        for picture in store.spread(self.pictures) {
            if let Ok(place) = way.at(picture.header.stamp_nanos, gap_nanos) {
                // What cannot be painted is told when all is painted.
                let _ = self.painter.picture(picture, &place.pose);
            }
        }
        self.told = Instant::now();
        let (model, evidence) = self.painter.model();
        (evidence.pictures > 0).then(|| Model { header: mesh.header.derived(), ..model })
    }
}
