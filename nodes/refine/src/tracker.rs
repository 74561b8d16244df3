//! The tracker's readings made smooth, and read at any moment.

use crate::gather::Gathered;
use geometry::{SmoothError, SmoothTrajectory, Smoothing, TimedPose};
use nalgebra::{Isometry3, UnitQuaternion, Vector3, Vector6};

/// The smoothed tracker of a scan.
#[derive(Debug, Clone)]
pub(crate) struct Smoothed {
    way: SmoothTrajectory,
}

impl Smoothed {
    pub fn new(gathered: &Gathered, smoothing: &Smoothing) -> Result<Self, SmoothError> {
        let readings = &gathered.readings;
        let lagging = gathered.rotation_stamps.iter().zip(readings).any(|(stamp, r)| *stamp != r.stamp_nanos);
        if !lagging {
            return Ok(Self { way: SmoothTrajectory::fit(readings, smoothing)? });
        }
        let turned = gathered.rotation_stamps.iter().zip(readings);
        let rotations: Vec<_> = turned.map(|(&stamp_nanos, r)| TimedPose { stamp_nanos, ..*r }).collect();
        Ok(Self { way: SmoothTrajectory::fit_apart(readings, &rotations, smoothing)? })
    }

    /// world_from_body at a moment; `None` where the tracker was silent.
    pub fn at(&self, stamp_nanos: i64) -> Option<Isometry3<f64>> {
        self.way.at(stamp_nanos)
    }

    /// world_from_body with its position read at a moment plus tau, its rotation later by the lag, and how both move by a
    /// second, along the axes of this body.
    pub fn base(&self, stamp_nanos: i64, [tau_s, lag_s]: [f64; 2]) -> (Isometry3<f64>, Vector6<f64>) {
        let (placed, twist) = self.read(stamp_nanos, tau_s);
        if lag_s == 0.0 {
            return (placed, twist);
        }
        let (turned, turning) = self.read(stamp_nanos, tau_s + lag_s);
        let velocity = turned.rotation.inverse() * (placed.rotation * twist.fixed_rows::<3>(0).into_owned());
        let mut moving = turning;
        moving.fixed_rows_mut::<3>(0).copy_from(&velocity);
        (Isometry3::from_parts(placed.translation, turned.rotation), moving)
    }

    /// world_from_body at a moment plus tau, and its twist in the moving frame. Where there is no reading at the later
    /// moment the pose goes on as at the earlier.
    fn read(&self, stamp_nanos: i64, tau_s: f64) -> (Isometry3<f64>, Vector6<f64>) {
        let later = stamp_nanos.saturating_add((tau_s * 1e9).round() as i64);
        match (self.way.at(later), self.way.velocity(later)) {
            (Some(pose), Some(twist)) => (pose, twist),
            _ => {
                let pose = self.way.at(stamp_nanos).unwrap_or_default();
                let twist = self.way.velocity(stamp_nanos).unwrap_or_default();
                let moved = twist * tau_s;
                let turn = UnitQuaternion::new(moved.fixed_rows::<3>(3).into_owned());
                let shift: Vector3<f64> = moved.fixed_rows::<3>(0).into();
                (pose * Isometry3::from_parts(shift.into(), turn), twist)
            }
        }
    }

    /// The white noise of a reading, one axis: metres and radians.
    pub fn white(&self) -> [f64; 2] {
        [self.way.position_sigma_m(), self.way.rotation_sigma_rad()].map(|axes| (axes.norm_squared() / 3.0).sqrt())
    }

    /// The penalty on third differences for knots of another spacing, position and rotation, in units of the readings'
    /// precision.
    pub fn stiffness(&self, step_s: f64) -> [f64; 2] {
        let ratio = self.way.knot_nanos() as f64 * 1e-9 / step_s;
        [self.way.lambda_position(), self.way.lambda_rotation()].map(|lambda| lambda * ratio.powi(5))
    }
}
