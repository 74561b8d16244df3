//! One pose from the readings around its moment: the smooth one where it is sure enough, else the one between its two
//! neighbours.

use super::part::{Fit, Part};
use crate::{NoPose, TimedPose, TrajectoryBuffer};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

/// How stiff the splines are from a moment on, and how noisy the readings.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tuning {
    pub stamp_nanos: i64,
    pub position: Part,
    pub rotation: Part,
}

/// Whether there will be a better moment to answer.
#[derive(Debug, Clone, Copy)]
pub(super) enum Moment {
    Early,
    Due,
}

/// Splines through the readings around some moments.
pub(super) struct Fitted {
    pub tuning: Tuning,
    pub position: Fit<3>,
    pub rotation: Fit<4>,
    pub newest: TimedPose,
}

/// A smooth pose; the variance is the larger of position's and rotation's, in units of a reading's.
pub(super) struct Smooth {
    pose: TimedPose,
    variance: f64,
    beside_outlier: bool,
}

/// A pose that is answered before the reading behind it has come is at least as sure as one between two readings: on a
/// straight line its variance is 1 at either and 1/2 half-way, 2/3 in the mean.
const EARLY_VARIANCE: f64 = 2.0 / 3.0;
/// A smooth pose that is less sure than a reading gives way to the readings around it,
const MOST_VARIANCE: f64 = 1.0;
/// unless one of them is an outlier; then it stands up to here.
const MOST_BESIDE_OUTLIER: f64 = 100.0;

impl Fitted {
    pub(super) fn at(&self, stamp_nanos: i64) -> Option<Smooth> {
        let (place, turned) = (self.position.at(stamp_nanos)?, self.rotation.at(stamp_nanos)?);
        let rotation = UnitQuaternion::from_quaternion(Quaternion::from(turned.value));
        let pose = TimedPose {
            stamp_nanos,
            pose: Isometry3::from_parts(Translation3::from(place.value), rotation),
            position_sigma_m: self.tuning.position.sigma(place.variance, self.newest.position_sigma_m),
            rotation_sigma_rad: self.tuning.rotation.sigma(turned.variance, self.newest.rotation_sigma_rad),
        };
        let variance = place.variance.max(turned.variance);
        Some(Smooth { pose, variance, beside_outlier: place.beside_outlier || turned.beside_outlier })
    }
}

/// The smooth pose where it is sure enough, else the one between the two readings; where readings are missing nobody asks
/// for the smooth one.
pub(super) fn judged(
    straight: Result<TimedPose, NoPose>,
    smooth: impl FnOnce() -> Option<Smooth>,
    moment: Moment,
) -> Result<TimedPose, NoPose> {
    if let Err(NoPose::Before | NoPose::Gap) = straight {
        return straight;
    }
    match (moment, smooth()) {
        (Moment::Early, Some(smooth)) if smooth.variance <= EARLY_VARIANCE => Ok(smooth.pose),
        (Moment::Early, _) => Err(NoPose::After),
        (Moment::Due, Some(smooth)) if smooth.variance <= MOST_VARIANCE => Ok(smooth.pose),
        (Moment::Due, Some(smooth)) if smooth.beside_outlier && smooth.variance <= MOST_BESIDE_OUTLIER => {
            Ok(smooth.pose)
        }
        (Moment::Due, Some(smooth)) if smooth.beside_outlier => Err(NoPose::Gap),
        (Moment::Due, _) => straight,
    }
}

/// Without smoothing: each part between its two neighbours.
pub(super) fn between(
    position: &[TimedPose],
    rotation: &[TimedPose],
    stamp_nanos: i64,
    gap_nanos: i64,
) -> Result<TimedPose, NoPose> {
    let at = |row: &[TimedPose]| {
        let mut buffer = TrajectoryBuffer::default();
        let near = row.partition_point(|r| r.stamp_nanos < stamp_nanos).saturating_sub(1);
        row[near..].iter().take(2).for_each(|reading| {
            buffer.push(*reading);
        });
        buffer.at(stamp_nanos, gap_nanos)
    };
    match (at(position), at(rotation)) {
        (Ok(place), Ok(turned)) => {
            let pose = Isometry3::from_parts(place.pose.translation, turned.pose.rotation);
            Ok(TimedPose { pose, rotation_sigma_rad: turned.rotation_sigma_rad, ..place })
        }
        (Err(NoPose::After), Err(other)) | (Err(other), _) | (_, Err(other)) => Err(other),
    }
}
