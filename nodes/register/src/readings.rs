//! The tracker's readings on the camera's clock.

use geometry::{NoPose, TimedPose, TrajectoryBuffer, rigid_from_wire};
use nalgebra::Isometry3;
use wire::{Pose, Quality};

/// Why a reading is not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum BadReading {
    NotFinite,
    Lost,
    Degraded,
    Backwards,
}

impl BadReading {
    pub(crate) fn reason(self) -> &'static str {
        match self {
            Self::NotFinite => "pose that is no rigid transform",
            Self::Lost => "pose that the tracker calls lost",
            Self::Degraded => "pose that the tracker calls degraded",
            Self::Backwards => "pose whose time goes backwards",
        }
    }
}

/// Positions and rotations, each at its own moment; `world_from_body`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Readings {
    positions: TrajectoryBuffer,
    /// Only when some reading's rotation was older than its position.
    rotations: TrajectoryBuffer,
    lagging: bool,
}

/// Readings older than this behind the newest are of no use to any profile that still waits.
const KEPT_NANOS: i64 = 10_000_000_000;

impl Readings {
    /// Takes a reading; returns it as it stands on the camera's clock.
    pub(crate) fn take(&mut self, pose: &Pose, offset_nanos: i64, use_degraded: bool) -> Result<TimedPose, BadReading> {
        match pose.quality {
            Quality::Lost => return Err(BadReading::Lost),
            Quality::Degraded if !use_degraded => return Err(BadReading::Degraded),
            _ => {}
        }
        let world_from_body = rigid_from_wire(&pose.world_from_body).ok_or(BadReading::NotFinite)?;
        let sigma = |axes: [f64; 3]| Some(axes.iter().copied().fold(0.0, f64::max)).filter(|sigma| sigma.is_finite());
        let reading = TimedPose {
            stamp_nanos: pose.header.stamp_nanos.saturating_add(offset_nanos),
            pose: world_from_body,
            position_sigma_m: sigma(pose.position_sigma_m).ok_or(BadReading::NotFinite)?,
            rotation_sigma_rad: sigma(pose.rotation_sigma_rad).ok_or(BadReading::NotFinite)?,
        };
        if !self.positions.push(reading) {
            return Err(BadReading::Backwards);
        }
        self.lagging |= pose.rotation_lag_nanos != 0;
        // A rotation that is older than the one before it adds nothing; the position stands all the same.
        self.rotations
            .push(TimedPose { stamp_nanos: reading.stamp_nanos.saturating_sub(pose.rotation_lag_nanos), ..reading });
        let oldest = reading.stamp_nanos.saturating_sub(KEPT_NANOS);
        self.positions.forget_before(oldest);
        self.rotations.forget_before(oldest);
        Ok(reading)
    }

    /// world_from_body at a moment of the camera's clock.
    pub(crate) fn at(&self, stamp_nanos: i64, gap_nanos: i64) -> Result<TimedPose, NoPose> {
        let position = self.positions.at(stamp_nanos, gap_nanos)?;
        if !self.lagging {
            return Ok(position);
        }
        let rotation = self.rotations.at(stamp_nanos, gap_nanos)?;
        let pose = Isometry3::from_parts(position.pose.translation, rotation.pose.rotation);
        Ok(TimedPose { pose, rotation_sigma_rad: rotation.rotation_sigma_rad, ..position })
    }

    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }
}
