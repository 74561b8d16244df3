//! The laser sheet (paper, section 2.2: all rays l + delta m of one line lie in one plane).

use nalgebra::{Point3, Vector3};

/// normal . p_in_camera = distance_m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LaserSheet {
    /// Unit normal, in the frame of the camera.
    pub normal: Vector3<f64>,
    /// Along the normal.
    pub distance_m: f64,
}

/// A sheet that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SheetError {
    /// No direction.
    #[error("[laser] normal = {0:?} has no direction")]
    Normal([f64; 3]),
    /// Through the camera's centre every ray lies in the sheet, or none crosses it.
    #[error(
        "[laser] distance_m = {0} along a unit normal: the sheet must pass beside the camera's centre, or nothing can be triangulated"
    )]
    Distance(f64),
}

impl LaserSheet {
    /// The sheet with this normal (any length) at this distance from the camera's centre.
    pub fn new(normal: Vector3<f64>, distance_m: f64) -> Result<Self, SheetError> {
        let norm = normal.norm();
        if !norm.is_finite() || norm < 1e-9 {
            return Err(SheetError::Normal(normal.into()));
        }
        let distance_m = distance_m / norm;
        if !distance_m.is_finite() || distance_m.abs() < 1e-6 {
            return Err(SheetError::Distance(distance_m));
        }
        Ok(Self { normal: normal / norm, distance_m })
    }

    /// Signed distance of a point from the sheet.
    pub fn distance_to(&self, p_in_camera: &Point3<f64>) -> f64 {
        self.normal.dot(&p_in_camera.coords) - self.distance_m
    }

    /// Where the ray mu v from the camera's centre meets the sheet; `None` when it runs along it or away from it.
    pub fn intersect(&self, direction: &Vector3<f64>) -> Option<Point3<f64>> {
        let approach = self.normal.dot(direction);
        let mu = self.distance_m / approach;
        (mu.is_finite() && mu > 0.0).then(|| Point3::from(direction * mu))
    }
}
