//! One picture's part in the settling: the points that it sees, and where it now seems to have been.

use crate::settle::level::Level;
use geometry::Camera;
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, UnitQuaternion, Vector3, Vector6};

/// A point of the surface in a view.
#[derive(Debug, Clone, Copy)]
pub struct Seen {
    /// Its number.
    pub point: u32,
    /// What the picture's value is to be multiplied with in each channel, so that every view says the same of a point.
    pub scale: [f32; 3],
    /// How much the view's word counts.
    pub weight: f32,
}

/// A picture among the others.
#[derive(Debug, Clone)]
pub struct View {
    /// camera_from_world as it came.
    pub camera_from_world: Isometry3<f64>,
    /// What it sees, in the order of the points.
    pub seen: Vec<Seen>,
    /// Its correction: camera_from_world = exp(correction) * as it came; metres, then radians.
    pub correction: Vector6<f64>,
}

/// exp of a small correction: shift and turn apart, the turn about the camera's centre.
pub fn moved(correction: &Vector6<f64>) -> Isometry3<f64> {
    let (shift, turn) = (correction.fixed_rows::<3>(0).into_owned(), correction.fixed_rows::<3>(3).into_owned());
    Isometry3::from_parts(Translation3::from(shift), UnitQuaternion::new(turn))
}

/// No picture is settled by more points.
const POINTS_MAX: usize = 2_000;

/// Keeps what is wanted, and of that evenly so many at most.
pub fn keep(seen: &mut Vec<Seen>, wanted: &[bool]) {
    seen.retain(|seen| wanted[seen.point as usize]);
    let count = seen.len();
    if count > POINTS_MAX {
        let mut at = 0;
        seen.retain(|_| {
            at += 1;
            at * POINTS_MAX / count > (at - 1) * POINTS_MAX / count
        });
    }
    seen.shrink_to_fit();
}

impl View {
    /// One that sees nothing.
    pub fn blind(world_from_camera: &Isometry3<f64>) -> Self {
        Self { camera_from_world: world_from_camera.inverse(), seen: Vec::new(), correction: Vector6::zeros() }
    }

    /// Without its correction.
    pub fn as_it_came(&self) -> Self {
        Self { correction: Vector6::zeros(), ..self.clone() }
    }

    /// What the picture says of each point that it sees, were its correction this one; not a number where it says
    /// nothing.
    pub fn says(
        &self,
        camera: &Camera,
        level: &Level,
        points: &[Point3<f64>],
        correction: &Vector6<f64>,
    ) -> Vec<[f32; 3]> {
        let camera_from_world = moved(correction) * self.camera_from_world;
        let value = |seen: &Seen| {
            let pixel = camera.project(&(camera_from_world * points[seen.point as usize]))?;
            let shown = level.at(&pixel)?;
            Some(std::array::from_fn(|c| shown.value[c] * seen.scale[c]))
        };
        self.seen.iter().map(|seen| value(seen).unwrap_or([f32::NAN; 3])).collect()
    }

    /// world_from_camera with the correction.
    pub fn world_from_camera(&self) -> Isometry3<f64> {
        (moved(&self.correction) * self.camera_from_world).inverse()
    }

    /// The rotation of camera_from_world with the correction.
    pub fn turn(&self) -> Matrix3<f64> {
        (moved(&self.correction) * self.camera_from_world).rotation.to_rotation_matrix().into_inner()
    }

    /// How far the correction shifts, in metres, and how far it turns, in radians.
    pub fn size(&self) -> [f64; 2] {
        [0, 3].map(|first| Vector3::from(self.correction.fixed_rows::<3>(first).into_owned()).norm())
    }
}
