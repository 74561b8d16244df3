//! The smooth way through all readings of a scan.

use super::readings::{is_finite, positions, rms, rotations, turn};
use super::track::{LEAST_READINGS, Track};
use super::{Silence, SmoothCounts, SmoothError, Smoothing, order};
use crate::TimedPose;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3, Vector6};

/// Where something was at any moment, from noisy readings: see the [module](crate::smooth) for the method.
#[derive(Debug, Clone)]
pub struct SmoothTrajectory {
    position: Track<3>,
    rotation: Track<4>,
    knot_nanos: i64,
    gaps: Vec<Silence>,
    counts: SmoothCounts,
}

/// More readings whose time goes backwards are two scans in one, or a clock that cannot be believed.
const MOST_BACKWARDS: f64 = 0.1;

impl SmoothTrajectory {
    /// Through readings in the order in which they came. Time and memory grow linearly with them.
    pub fn fit(readings: &[TimedPose], config: &Smoothing) -> Result<Self, SmoothError> {
        Self::fit_apart(readings, readings, config)
    }

    /// The same where positions and rotations were sampled at different moments (`wire::Pose::rotation_lag_nanos`): of
    /// the first row only the positions are looked at, of the second only the rotations.
    pub fn fit_apart(
        positions_at: &[TimedPose],
        rotations_at: &[TimedPose],
        config: &Smoothing,
    ) -> Result<Self, SmoothError> {
        config.check()?;
        let mut counts = SmoothCounts { readings: positions_at.len(), ..SmoothCounts::default() };
        let positions_at = in_order(positions_at, &mut counts)?;
        let rotations_at = in_order(rotations_at, &mut SmoothCounts::default())?;
        let too_few =
            || SmoothError::TooFew { usable: positions_at.len().min(rotations_at.len()), needed: LEAST_READINGS };
        let position = Track::fit(positions(&positions_at), config, |_, off| *off).ok_or_else(too_few)?;
        let rotation = Track::fit(rotations(&rotations_at), config, turn).ok_or_else(too_few)?;
        counts.position_outliers = position.outliers;
        counts.rotation_outliers = rotation.outliers;
        counts.stranded = position.stranded.max(rotation.stranded);
        let gaps = Silence::joined(position.silences.iter().chain(&rotation.silences).copied().collect());
        Ok(Self { position, rotation, knot_nanos: config.knot_nanos(), gaps, counts })
    }

    /// a_from_b as the readings have it; `None` before the first reading, behind the last and within [`Self::gaps`].
    pub fn at(&self, stamp_nanos: i64) -> Option<Isometry3<f64>> {
        let translation = Translation3::from(self.position.spline(stamp_nanos)?.at(stamp_nanos)?);
        let rotation = self.rotation.spline(stamp_nanos)?.at(stamp_nanos)?;
        Some(Isometry3::from_parts(translation, UnitQuaternion::from_quaternion(Quaternion::from(rotation))))
    }

    /// The twist in the moving frame b: m/s along its axes, then rad/s about them. A moment dt later the pose is
    /// `at * exp(twist dt)`. `None` where there is no pose.
    pub fn velocity(&self, stamp_nanos: i64) -> Option<Vector6<f64>> {
        let pose = self.at(stamp_nanos)?;
        let linear = pose.rotation.inverse() * self.position.spline(stamp_nanos)?.rate(stamp_nanos)?;
        let rotation = self.rotation.spline(stamp_nanos)?;
        let angular: Vector3<f64> = turn(&rotation.at(stamp_nanos)?, &rotation.rate(stamp_nanos)?);
        Some(Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z))
    }

    /// One standard deviation of what the white noise leaves in the smooth pose, on each axis: metres and radians.
    /// Errors that change slowly are not in it, because nothing in the readings tells of them.
    pub fn sigma(&self, stamp_nanos: i64) -> Option<(f64, f64)> {
        let position = self.position.spline(stamp_nanos)?.variance(stamp_nanos)?.sqrt() * rms(&self.position.sigma);
        let rotation = self.rotation.spline(stamp_nanos)?.variance(stamp_nanos)?.sqrt() * rms(&self.rotation.sigma);
        Some((position, rotation))
    }

    /// One standard deviation of a reading's white noise along the axes of frame a.
    pub fn position_sigma_m(&self) -> Vector3<f64> {
        self.position.sigma
    }

    /// One standard deviation of a reading's white noise about the axes of frame b.
    pub fn rotation_sigma_rad(&self) -> Vector3<f64> {
        self.rotation.sigma
    }

    /// The weight of squared third differences of position control points against squared residuals. For another
    /// spacing of knots, d' instead of d, the same stiffness is lambda (d / d')^5.
    pub fn lambda_position(&self) -> f64 {
        self.position.lambda
    }

    /// The same for rotations; the control points are of quaternions.
    pub fn lambda_rotation(&self) -> f64 {
        self.rotation.lambda
    }

    /// Between two knots.
    pub fn knot_nanos(&self) -> i64 {
        self.knot_nanos
    }

    /// The first and the last moment that has a pose.
    pub fn span_nanos(&self) -> (i64, i64) {
        let (position, rotation) = (self.position.span_nanos(), self.rotation.span_nanos());
        position.zip(rotation).map_or((0, 0), |(p, r)| (p.0.max(r.0), p.1.min(r.1)))
    }

    /// Where the readings that were used were silent for longer than [`Smoothing::most_gap_ms`]: there is no pose
    /// between the ends of each.
    pub fn gaps(&self) -> &[Silence] {
        &self.gaps
    }

    /// What became of the readings.
    pub fn counts(&self) -> SmoothCounts {
        self.counts
    }
}

/// Without what is not finite and what goes backwards in time.
fn in_order(readings: &[TimedPose], counts: &mut SmoothCounts) -> Result<Vec<TimedPose>, SmoothError> {
    let finite: Vec<&TimedPose> = readings.iter().filter(|reading| is_finite(reading)).collect();
    let stamps: Vec<i64> = finite.iter().map(|reading| reading.stamp_nanos).collect();
    let rising = order::longest_rising(&stamps);
    counts.not_finite = readings.len() - finite.len();
    counts.backwards = finite.len() - rising.len();
    if counts.backwards as f64 > MOST_BACKWARDS * finite.len() as f64 {
        return Err(SmoothError::Backwards { count: counts.backwards, of: finite.len() });
    }
    Ok(rising.into_iter().map(|i| *finite[i]).collect())
}
