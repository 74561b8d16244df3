//! The frames of one sweep.

use geometry::TimedPose;
use nalgebra::Isometry3;
use rayon::prelude::*;
use std::cell::RefCell;
use std::ops::Range;
use wire::{Bulk, Clock, Frame, Header, Light, Phase, PixelFormat, Trajectory, TrajectorySample};
use world::optics::{CameraModelSim, OpticsError, Workspace};
use world::{Hand, Known, Setup, SetupError};

thread_local! {
    /// A frame needs some 20 MB while it is made, and asking the system for it costs a tenth of the frame.
    static MEMORY: RefCell<Workspace> = RefCell::default();
}

/// The camera on the hand's way.
#[derive(Debug, Clone)]
pub struct CameraSim {
    model: CameraModelSim,
    hand: Hand,
    frames: u64,
}

/// Why there are no pictures.
#[derive(Debug, thiserror::Error)]
pub enum CameraSimError {
    /// There is no world to show.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// No camera can show it.
    #[error(transparent)]
    Optics(#[from] OpticsError),
}

impl CameraSim {
    /// Before a world that is there.
    pub fn new(known: &Known) -> Result<Self, CameraSimError> {
        let model = CameraModelSim::new(&known.scene, &known.rig, known.seed)?;
        let frames = (known.hand.duration_s() * model.section().rate_hz).floor() as u64;
        Ok(Self { model, hand: known.hand.clone(), frames })
    }

    /// Before a world that is yet to be read.
    pub fn open(setup: &Setup) -> Result<Self, CameraSimError> {
        Self::new(&setup.open()?)
    }

    /// How many frames the sweep has.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// The middle of a frame's exposure, in nanoseconds from the start of the sweep.
    pub fn stamp_nanos(&self, index: u64) -> i64 {
        ((index as f64 + 0.5) / self.model.section().rate_hz * 1e9).round() as i64
    }

    /// What the operator was doing, and what lit the frame.
    pub fn light(&self, index: u64) -> (Phase, Light) {
        let phase = self.hand.phase(seconds(self.stamp_nanos(index)));
        let lamp = match phase {
            Phase::Colour => true,
            Phase::Both => index.is_multiple_of(self.model.section().lamp_every),
            Phase::Aim | Phase::Shape | Phase::End => false,
        };
        (phase, Light { laser: !lamp, lamp })
    }

    /// One frame.
    pub fn frame(&self, index: u64) -> Frame {
        let (phase, light) = self.light(index);
        let way = self.world_from_camera(index);
        let mut frame = MEMORY.with_borrow_mut(|memory| self.model.render(index, &way, light, memory));
        let stamp_nanos = self.stamp_nanos(index);
        frame.header = Header { phase, seq: index, stamp_nanos, clock: Clock::Scan, ..Header::default() };
        frame
    }

    /// Several frames, rendered on all cores.
    pub fn batch(&self, indices: Range<u64>) -> Vec<Frame> {
        indices.into_par_iter().map(|index| self.frame(index)).collect()
    }

    /// A frame without pixels, as goes behind the last.
    pub fn blank(&self) -> Frame {
        Frame {
            header: Header::default(),
            width: 0,
            height: 0,
            stride: 0,
            format: PixelFormat::Rgb8,
            light: Light { laser: false, lamp: false },
            exposure_nanos: 0,
            gain: 1.0,
            gamma: self.model.section().sensor.gamma as f32,
            data: Bulk::default(),
        }
    }

    /// For reports alone: where the camera was at the middle of a frame's exposure.
    pub fn world_from_camera(&self, index: u64) -> Isometry3<f64> {
        self.hand.world_from_camera(seconds(self.stamp_nanos(index)))
    }

    /// For reports alone: where the camera was at each frame. The header's stamp is the last one's.
    pub fn truth(&self) -> Trajectory {
        let sample = |index| {
            let (stamp_nanos, pose) = (self.stamp_nanos(index), self.world_from_camera(index));
            TrajectorySample::from(&TimedPose { stamp_nanos, pose, position_sigma_m: 0.0, rotation_sigma_rad: 0.0 })
        };
        let samples: Bulk<TrajectorySample> = (0..self.frames).map(sample).collect();
        let stamp_nanos = samples.last().map_or(0, |sample| sample.stamp_nanos);
        Trajectory { header: Header { stamp_nanos, ..Header::default() }, samples }
    }

    /// For tests and reports alone: (u, v) of the laser line's centre wherever it crosses a row (or a column, as the rig
    /// says), as if the laser were on.
    pub fn truth_stripe(&self, index: u64) -> Vec<(f64, f64)> {
        let way = self.world_from_camera(index);
        MEMORY.with_borrow_mut(|memory| self.model.truth_stripe(&way, memory))
    }
}

fn seconds(nanos: i64) -> f64 {
    nanos as f64 * 1e-9
}
