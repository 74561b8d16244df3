//! What of the truth the camera could see: only that can be asked of a model.

use geometry::{Camera, MeshIndex, SurfaceSample};
use nalgebra::{Isometry3, Point3};
use rayon::prelude::*;

/// When a point counts as seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gate {
    /// Nearer along the optical axis nothing is measured.
    pub near_m: f64,
    /// Farther along the optical axis nothing is measured.
    pub far_m: f64,
    /// Between the line of sight and the normal.
    pub most_incidence_rad: f64,
}

impl Default for Gate {
    /// 0.1 m to 0.35 m, 75 degrees.
    fn default() -> Self {
        Self { near_m: 0.1, far_m: 0.35, most_incidence_rad: 75f64.to_radians() }
    }
}

/// The way of the camera is looked at in at most so many places, evenly spread over it: a few centimetres apart.
const MOST_POSES: usize = 1000;
/// What hides a point is this much before it, or it is the point's own surface.
const BEFORE_M: f64 = 5e-5;

/// For each sample of the truth whether the camera could see it from anywhere on its way: in the picture, in the depth of
/// the gate, not too slanted, and with nothing before it. `scene` holds all that can hide, the truth included.
pub fn seen_mask(
    samples: &[SurfaceSample],
    scene: &MeshIndex,
    world_from_camera: &[Isometry3<f64>],
    camera: &Camera,
    gate: &Gate,
) -> Vec<bool> {
    let every = world_from_camera.len().div_ceil(MOST_POSES).max(1);
    let poses: Vec<View> = world_from_camera.iter().step_by(every).map(View::new).collect();
    let least_cos = gate.most_incidence_rad.cos();
    let sees = |view: &View, sample: &SurfaceSample| {
        let line_of_sight = view.centre - sample.point;
        let distance = line_of_sight.norm();
        if sample.normal.dot(&line_of_sight) < least_cos * distance {
            return false;
        }
        let in_camera = view.camera_from_world * sample.point;
        let in_gate = (gate.near_m..=gate.far_m).contains(&in_camera.z);
        let in_picture = || camera.project(&in_camera).is_some_and(|pixel| camera.contains(&pixel));
        // The lens may fold rays from far outside back into the picture: the pixel must look at the point.
        let looks_there = || {
            let ray = camera.project(&in_camera).map(|pixel| camera.direction(pixel) * in_camera.z);
            ray.is_some_and(|ray| (ray - in_camera.coords).norm() < 1e-6)
        };
        let free = || scene.cast(&view.centre, &(-line_of_sight / distance), distance - BEFORE_M).is_none();
        in_gate && in_picture() && looks_there() && free()
    };
    samples.par_iter().map(|sample| poses.iter().any(|view| sees(view, sample))).collect()
}

struct View {
    centre: Point3<f64>,
    camera_from_world: Isometry3<f64>,
}

impl View {
    fn new(world_from_camera: &Isometry3<f64>) -> Self {
        let centre = Point3::from(world_from_camera.translation.vector);
        Self { centre, camera_from_world: world_from_camera.inverse() }
    }
}
