//! From poses to what the splines go through.

use super::run::Sample;
use crate::TimedPose;
use nalgebra::{SVector, Vector3, Vector4};

/// How much one reading may count against another.
const LEAST_WEIGHT: f64 = 1e-4;
const MOST_WEIGHT: f64 = 1e2;
/// How much of the reference direction is of the newest reading.
const FOLLOW: f64 = 0.3;

pub(super) fn is_finite(reading: &TimedPose) -> bool {
    let rotation = reading.pose.rotation.coords;
    let finite = reading.pose.translation.vector.iter().chain(rotation.iter()).all(|value| value.is_finite());
    finite && (rotation.norm() - 1.0).abs() < 1e-3
}

/// In the order of the readings.
pub(super) fn positions(readings: &[TimedPose]) -> Vec<Sample<3>> {
    samples(readings, |r| r.position_sigma_m, |r| r.pose.translation.vector)
}

/// Quaternions (x, y, z, w) with their signs so that neighbours are near: q and -q are one rotation. The sign follows a
/// mean of the readings before, so that one that is upside down does not turn all behind it.
pub(super) fn rotations(readings: &[TimedPose]) -> Vec<Sample<4>> {
    let mut reference = Vector4::zeros();
    let signed = |reading: &TimedPose| {
        let q = reading.pose.rotation.coords;
        let q = if q.dot(&reference) < 0.0 { -q } else { q };
        reference = reference * (1.0 - FOLLOW) + q * FOLLOW;
        q
    };
    // A quaternion turns by half the angle.
    samples(readings, |r| 0.5 * r.rotation_sigma_rad, signed)
}

/// The rotation vector about the axes of the body that leads from the spline to the reading.
pub(super) fn turn(value: &Vector4<f64>, off: &Vector4<f64>) -> Vector3<f64> {
    let conjugate = nalgebra::Quaternion::from(*value).conjugate();
    2.0 * (conjugate * nalgebra::Quaternion::from(*off)).imag() / value.norm_squared()
}

/// Of one axis, when three are known.
pub(super) fn rms(axes: &Vector3<f64>) -> f64 {
    (axes.norm_squared() / 3.0).sqrt()
}

fn samples<const D: usize>(
    readings: &[TimedPose],
    sigma: impl Fn(&TimedPose) -> f64,
    mut value: impl FnMut(&TimedPose) -> SVector<f64, D>,
) -> Vec<Sample<D>> {
    let stated = |reading: &TimedPose| Some(sigma(reading)).filter(|s| s.is_finite() && *s > 0.0);
    let mut all: Vec<f64> = readings.iter().filter_map(stated).collect();
    let middle = all.len() / 2;
    let usual = if all.is_empty() { 0.0 } else { *all.select_nth_unstable_by(middle, f64::total_cmp).1 };
    let sample = |reading: &TimedPose| Sample {
        stamp_nanos: reading.stamp_nanos,
        value: value(reading),
        weight: stated(reading).map_or(1.0, |s| (usual / s).powi(2).clamp(LEAST_WEIGHT, MOST_WEIGHT)),
        stated: stated(reading).unwrap_or(0.0),
        active: true,
    };
    readings.iter().map(sample).collect()
}
