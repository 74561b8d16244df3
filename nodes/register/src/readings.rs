//! The tracker's readings on the camera's clock.

use geometry::{NoPose, TimedPose, TrajectoryBuffer, rigid_from_wire};
use nalgebra::Isometry3;
use std::collections::VecDeque;
use wire::{Pose, Quality};

/// Why a reading is not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum BadReading {
    NotFinite,
    Lost,
    Degraded,
    Backwards,
    Jump,
}

impl BadReading {
    pub(crate) fn reason(self) -> &'static str {
        match self {
            Self::NotFinite => "pose that is no rigid transform",
            Self::Lost => "pose that the tracker calls lost",
            Self::Degraded => "pose that the tracker calls degraded",
            Self::Backwards => "pose whose time goes backwards",
            Self::Jump => "pose whose time is far from the one before",
        }
    }
}

/// Positions and rotations, each at its own moment; `world_from_body`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Readings {
    positions: TrajectoryBuffer,
    /// Looked at only when some reading's rotation was older than its position.
    rotations: TrajectoryBuffer,
    lagging: bool,
    /// Readings that are not told yet as a part of the way.
    untold: VecDeque<TimedPose>,
    /// The last stamp that was far from its neighbours.
    suspect: Option<i64>,
}

/// Readings are kept so long behind the newest, so that a node that starts in mid-scan can take all poses before the
/// first profile.
pub(crate) const KEPT_NANOS: i64 = 600_000_000_000;
/// A single reading so far from the one before is no reading; two in a row are a clock that was set.
const JUMP_NANOS: u64 = 60_000_000_000;

impl Readings {
    /// Takes a reading.
    pub(crate) fn take(&mut self, pose: &Pose, offset_nanos: i64, use_degraded: bool) -> Result<(), BadReading> {
        match pose.quality {
            Quality::Lost => return Err(BadReading::Lost),
            Quality::Degraded if !use_degraded => return Err(BadReading::Degraded),
            _ => {}
        }
        let world_from_body = rigid_from_wire(&pose.world_from_body).ok_or(BadReading::NotFinite)?;
        let sigma = |axes: [f64; 3]| {
            let good = axes.iter().all(|sigma| sigma.is_finite() && *sigma >= 0.0);
            good.then(|| axes.iter().copied().fold(0.0, f64::max)).ok_or(BadReading::NotFinite)
        };
        let reading = TimedPose {
            stamp_nanos: pose.header.stamp_nanos.saturating_add(offset_nanos),
            pose: world_from_body,
            position_sigma_m: sigma(pose.position_sigma_m)?,
            rotation_sigma_rad: sigma(pose.rotation_sigma_rad)?,
        };
        self.check_clock(reading.stamp_nanos)?;
        if !self.positions.push(reading) {
            return Err(BadReading::Backwards);
        }
        self.lagging |= pose.rotation_lag_nanos != 0;
        // A rotation that is older than the one before it adds nothing; the position stands all the same.
        self.rotations
            .push(TimedPose { stamp_nanos: reading.stamp_nanos.saturating_sub(pose.rotation_lag_nanos), ..reading });
        self.untold.push_back(reading);
        self.forget();
        Ok(())
    }

    /// Refuses a lone stamp far from the last; of two that follow one another the second is believed.
    fn check_clock(&mut self, stamp_nanos: i64) -> Result<(), BadReading> {
        let Some(newest) = self.newest() else { return Ok(()) };
        if stamp_nanos.abs_diff(newest) <= JUMP_NANOS {
            self.suspect = None;
            return Ok(());
        }
        let follows = |suspect: i64| stamp_nanos > suspect && stamp_nanos.abs_diff(suspect) <= JUMP_NANOS;
        let believed = self.suspect.is_some_and(follows);
        self.suspect = Some(stamp_nanos);
        if !believed {
            return Err(BadReading::Jump);
        }
        if stamp_nanos < newest {
            *self = Self::default();
        }
        Ok(())
    }

    /// Drops what is too old, but not at every reading: a buffer moves all it holds.
    fn forget(&mut self) {
        let Some(newest) = self.newest() else { return };
        let oldest = newest.saturating_sub(KEPT_NANOS);
        let first = self.positions.samples().first().map_or(newest, |sample| sample.stamp_nanos);
        if first < oldest.saturating_sub(KEPT_NANOS / 4) {
            self.positions.forget_before(oldest);
            self.rotations.forget_before(oldest);
            self.untold.retain(|reading| reading.stamp_nanos >= oldest);
        }
    }

    /// The stamp of the last reading, on the camera's clock.
    pub(crate) fn newest(&self) -> Option<i64> {
        self.positions.samples().last().map(|sample| sample.stamp_nanos)
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

    /// world_from_body at the readings since the last call, as far as their rotations are known by now.
    pub(crate) fn tell(&mut self, gap_nanos: i64) -> Vec<TimedPose> {
        let mut way = Vec::new();
        while let Some(reading) = self.untold.front() {
            match self.at(reading.stamp_nanos, gap_nanos) {
                Ok(pose) => way.push(pose),
                Err(NoPose::After) => break,
                // No rotation was measured around it: the way has no sample there.
                Err(NoPose::Before | NoPose::Gap) => {}
            }
            self.untold.pop_front();
        }
        way
    }
}
