//! Frames and poses as the solver sees them: fixed inputs on one side, the unknowns' effect on the other.

use crate::gather::Gathered;
use crate::tracker::Smoothed;
use crate::unknowns::{Row, Unknowns};
use nalgebra::{Isometry3, Matrix3, Point3, Vector3, Vector6};
use rayon::prelude::*;

/// A frame that has a pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placed {
    /// Which of the gathered frames.
    pub frame: usize,
    pub stamp_nanos: i64,
    /// On the splines' time.
    pub t_s: f64,
}

/// Where a frame is at the present unknowns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FramePose {
    pub row: Row,
    pub world_from_body: Isometry3<f64>,
    /// world_from_camera, rotation and origin, single precision; the origin relative to the solver's.
    pub camera_rotation: Matrix3<f32>,
    pub camera_origin: Vector3<f32>,
    /// Makes a normal in the world the derivative by the correction: see [`FramePose::jacobian`].
    world_from_base: Matrix3<f32>,
    world_from_body_rotation: Matrix3<f32>,
    right_jacobian: Matrix3<f32>,
}

/// What does not change between iterations.
pub(crate) struct Problem<'a> {
    pub gathered: &'a Gathered,
    pub smoothed: &'a Smoothed,
    pub body_from_camera: Isometry3<f64>,
    pub frames: &'a [Placed],
    pub unknowns: Unknowns,
    /// Where single-precision coordinates begin.
    pub origin: Vector3<f64>,
}

impl Problem<'_> {
    /// Where the splines' time begins.
    pub fn start_nanos(&self) -> i64 {
        self.gathered.frames.first().map_or(0, |frame| frame.header.stamp_nanos)
    }

    /// The rows of all frames at the offsets that `x` has: the smoothed tracker read anew.
    pub fn rows(&self, x: &[f64]) -> Vec<Row> {
        let offsets_s = self.unknowns.offsets_s(x);
        let row = |frame: &Placed| {
            let (base, twist) = self.smoothed.base(frame.stamp_nanos, offsets_s);
            self.unknowns.row(frame.t_s, base, twist, &self.origin)
        };
        self.frames.par_iter().map(row).collect()
    }

    /// Where all frames are.
    pub fn poses(&self, x: &[f64]) -> Vec<FramePose> {
        let rows = self.rows(x);
        rows.par_iter().map(|row| self.pose(row, &self.unknowns.correction(row, x, false))).collect()
    }

    /// Where one frame is after a correction.
    pub fn pose(&self, row: &Row, correction: &Vector6<f64>) -> FramePose {
        let world_from_body = row.corrected(correction);
        let camera = world_from_body * self.body_from_camera;
        let turn: Vector3<f64> = correction.fixed_rows::<3>(3).into();
        FramePose {
            row: *row,
            world_from_body,
            camera_rotation: camera.rotation.to_rotation_matrix().into_inner().cast(),
            camera_origin: (camera.translation.vector - self.origin).cast(),
            world_from_base: row.world_from_base.cast(),
            world_from_body_rotation: world_from_body.rotation.to_rotation_matrix().into_inner().cast(),
            right_jacobian: right_jacobian(&turn).cast(),
        }
    }

    /// A point of the camera's frame on the handset.
    pub fn in_body(&self, position_m: &[f32; 3]) -> Vector3<f64> {
        (self.body_from_camera * Point3::from(Vector3::from(*position_m).cast::<f64>())).coords
    }
}

impl FramePose {
    /// d(n . x) / d(dt, dr) for a point `q` of the handset: [R_base^T n, J_r(dr)^T (q x R^T n)]; exact for any dr,
    /// since R_base exp(dr + d) = R exp(J_r(dr) d) (Sola et al. 2018, equation 67).
    pub fn jacobian(&self, normal: &Vector3<f32>, q: &Vector3<f32>) -> [f32; 6] {
        let shift = self.world_from_base.tr_mul(normal);
        let turn = self.right_jacobian.tr_mul(&q.cross(&self.world_from_body_rotation.tr_mul(normal)));
        [shift.x, shift.y, shift.z, turn.x, turn.y, turn.z]
    }
}

/// The right Jacobian of SO(3) (Sola et al. 2018, equation 143).
pub(crate) fn right_jacobian(turn: &Vector3<f64>) -> Matrix3<f64> {
    let angle = turn.norm();
    let cross = turn.cross_matrix();
    let (first, second) = if angle < 1e-4 {
        (0.5, 1.0 / 6.0)
    } else {
        ((1.0 - angle.cos()) / angle.powi(2), (angle - angle.sin()) / angle.powi(3))
    };
    Matrix3::identity() - cross * first + cross * cross * second
}
