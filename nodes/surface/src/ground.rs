//! The table on which the thing stands: it bounds what nobody saw.

use nalgebra::Vector3;
use wire::TablePlane;

/// Farther from the origin nothing is scanned.
const FARTHEST_M: f64 = 2000.0;

/// A plane that nothing of the thing is below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    normal: Vector3<f64>,
    distance_m: f64,
    /// What nobody saw and is no higher stands on it.
    pub standing_m: f32,
}

impl Ground {
    /// `None` when it is no plane, or one that no scan came near.
    pub fn new(table: &TablePlane, standing_m: f32) -> Option<Self> {
        let normal = Vector3::from(table.normal);
        let is_plane = (normal.norm() - 1.0).abs() < 1e-3 && table.distance_m.abs() < FARTHEST_M;
        is_plane.then_some(Self { normal, distance_m: table.distance_m, standing_m })
    }

    /// Above the table.
    pub fn height_m(&self, point: &Vector3<f32>) -> f32 {
        (self.normal.dot(&point.cast()) - self.distance_m) as f32
    }

    /// Lays a point that is below some height onto the table, and tells whether it was.
    pub fn lay(&self, point: &mut Vector3<f32>, below_m: f32) -> bool {
        let height_m = self.height_m(point);
        let is_low = height_m < below_m;
        if is_low {
            *point -= (self.normal * f64::from(height_m)).cast::<f32>();
        }
        is_low
    }
}
