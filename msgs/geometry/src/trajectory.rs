//! Where something was at any moment between its samples.

use crate::pose::interpolate;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use wire::TrajectorySample;

/// A pose at a moment, with what is known of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedPose {
    /// The moment.
    pub stamp_nanos: i64,
    /// a_from_b, whatever the trajectory is of.
    pub pose: Isometry3<f64>,
    /// One standard deviation of the position.
    pub position_sigma_m: f64,
    /// One standard deviation of the rotation.
    pub rotation_sigma_rad: f64,
}

/// Why there is no pose for a moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, thiserror::Error)]
pub enum NoPose {
    /// Nothing has been measured before it.
    #[error("before the first pose")]
    Before,
    /// The sample behind it has not come yet.
    #[error("after the last pose")]
    After,
    /// The samples around it are too far apart to interpolate.
    #[error("inside a gap of the tracker")]
    Gap,
}

/// Samples in the order of their stamps.
#[derive(Debug, Clone, Default)]
pub struct TrajectoryBuffer {
    samples: Vec<TimedPose>,
}

impl TrajectoryBuffer {
    /// Takes a sample; refuses one that is not later than the last (`false`).
    pub fn push(&mut self, sample: TimedPose) -> bool {
        let later = self.samples.last().is_none_or(|last| sample.stamp_nanos > last.stamp_nanos);
        if later {
            self.samples.push(sample);
        }
        later
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.samples.clear();
    }

    /// Forgets what lies before a moment, but for the one sample that is needed to interpolate at it.
    pub fn forget_before(&mut self, stamp_nanos: i64) {
        let keep_from = self.samples.partition_point(|s| s.stamp_nanos <= stamp_nanos).saturating_sub(1);
        self.samples.drain(..keep_from);
    }

    /// The samples.
    pub fn samples(&self) -> &[TimedPose] {
        &self.samples
    }

    /// The pose at a moment, between samples at most `gap_nanos` apart. The sigmas are the larger of both neighbours'.
    pub fn at(&self, stamp_nanos: i64, gap_nanos: i64) -> Result<TimedPose, NoPose> {
        let after = self.samples.partition_point(|s| s.stamp_nanos < stamp_nanos);
        let Some(b) = self.samples.get(after) else { return Err(NoPose::After) };
        if b.stamp_nanos == stamp_nanos {
            return Ok(*b);
        }
        let Some(a) = after.checked_sub(1).map(|i| &self.samples[i]) else { return Err(NoPose::Before) };
        let span = b.stamp_nanos.saturating_sub(a.stamp_nanos);
        if span > gap_nanos {
            return Err(NoPose::Gap);
        }
        let at = (stamp_nanos - a.stamp_nanos) as f64 / span as f64;
        Ok(TimedPose {
            stamp_nanos,
            pose: interpolate(&a.pose, &b.pose, at),
            position_sigma_m: a.position_sigma_m.max(b.position_sigma_m),
            rotation_sigma_rad: a.rotation_sigma_rad.max(b.rotation_sigma_rad),
        })
    }
}

impl From<&TimedPose> for TrajectorySample {
    fn from(sample: &TimedPose) -> Self {
        let q = sample.pose.rotation.quaternion();
        Self {
            stamp_nanos: sample.stamp_nanos,
            translation_m: sample.pose.translation.vector.into(),
            rotation_wxyz: [q.w, q.i, q.j, q.k],
            position_sigma_m: sample.position_sigma_m,
            rotation_sigma_rad: sample.rotation_sigma_rad,
        }
    }
}

impl From<&TrajectorySample> for TimedPose {
    fn from(sample: &TrajectorySample) -> Self {
        let [w, x, y, z] = sample.rotation_wxyz;
        Self {
            stamp_nanos: sample.stamp_nanos,
            pose: Isometry3::from_parts(
                Translation3::from(sample.translation_m),
                UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)),
            ),
            position_sigma_m: sample.position_sigma_m,
            rotation_sigma_rad: sample.rotation_sigma_rad,
        }
    }
}
