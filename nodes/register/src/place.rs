//! Where a camera puts its points.

use nalgebra::{Isometry3, Matrix3, Point3, Vector3};
use wire::{ProfilePoint, ScanPoint};

/// R and p in single precision, relative to the camera's own place so that nothing is lost far from the origin.
pub(crate) struct Place {
    rotation: Matrix3<f32>,
    camera_in_world: Point3<f64>,
}

impl Place {
    pub(crate) fn new(world_from_camera: &Isometry3<f64>) -> Self {
        let rotation = world_from_camera.rotation.to_rotation_matrix().into_inner().cast();
        Self { rotation, camera_in_world: Point3::from(world_from_camera.translation.vector) }
    }

    /// R x + p; `None` when it is not finite.
    pub(crate) fn of(&self, point: &ProfilePoint) -> Option<ScanPoint> {
        let ray = self.rotation * Vector3::from(point.position_m);
        let to_sensor = -ray / ray.norm();
        let position = [0, 1, 2].map(|axis| (self.camera_in_world[axis] + f64::from(ray[axis])) as f32);
        let finite =
            position.iter().chain(to_sensor.iter()).chain([&point.range_sigma_m]).all(|value| value.is_finite());
        finite.then(|| ScanPoint {
            position_m: position,
            to_sensor: to_sensor.into(),
            sigma_m: point.range_sigma_m,
            amplitude: point.amplitude,
        })
    }
}
