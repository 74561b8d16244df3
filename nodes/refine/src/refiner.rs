//! Gathers, and refines what has been gathered.

use crate::finish::finish;
use crate::gather::Gathered;
use crate::live::{self, Live};
use crate::refinement::Refinement;
use crate::{Config, ConfigError};
use geometry::{SmoothError, rigid_from_wire};
use nalgebra::Isometry3;
use wire::{Calibration, Pose, Profile};

/// Why nothing can be refined.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RefineError {
    /// The settings.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Hand-eye.
    #[error("the calibration's body_from_camera is no rigid transform: {0:?}")]
    HandEye(wire::RigidPose),
    /// The tracker.
    #[error("the tracker's readings cannot be made smooth: {0}")]
    Tracker(#[from] SmoothError),
    /// Nothing was seen.
    #[error("no frame with points has a pose; {frames} frames came")]
    NoFrames {
        /// So many had points.
        frames: usize,
    },
}

/// One scan of one calibrated handset: the first message says which, and those of any other are refused.
#[derive(Debug, Clone)]
pub struct Refiner {
    config: Config,
    body_from_camera: Isometry3<f64>,
    offset_nanos: i64,
    gathered: Gathered,
    live: Live,
}

impl Refiner {
    /// For one calibrated handset.
    pub fn new(config: Config, calibration: &Calibration) -> Result<Self, RefineError> {
        config.check()?;
        let hand_eye = calibration.body_from_camera;
        Ok(Self {
            config,
            body_from_camera: rigid_from_wire(&hand_eye).ok_or(RefineError::HandEye(hand_eye))?,
            offset_nanos: calibration.pose_offset_nanos,
            gathered: Gathered::default(),
            live: Live::default(),
        })
    }

    /// Takes a reading of the tracker. In any order with the profiles.
    pub fn pose(&mut self, pose: &Pose) {
        self.gathered.pose(pose, self.offset_nanos, self.config.use_degraded);
    }

    /// Takes the points of a laser-lit picture. Those of an unlit one have no points and say nothing.
    pub fn profile(&mut self, profile: &Profile) {
        self.gathered.profile(profile);
    }

    /// The number of the scan that is gathered; `None` before its first message.
    pub fn scan(&self) -> Option<u64> {
        self.gathered.scan()
    }

    /// One live step on everything that has come; `None` while it is less than two seconds. Never worse than the smoothed
    /// tracker, as far as the points themselves can tell. Of the time it takes, what the surfels cost is bounded by the
    /// surface; what smoothing and the frames' own unknowns cost grows with the scan's length.
    pub fn tick(&mut self) -> Option<Refinement> {
        live::tick(&self.config, &self.gathered, self.body_from_camera, &mut self.live)
    }

    /// The full schedule on everything that has come. The refiner stays as it is.
    pub fn finish(&self) -> Result<Refinement, RefineError> {
        finish(&self.config, &self.gathered, self.body_from_camera)
    }
}
