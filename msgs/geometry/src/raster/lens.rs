//! The lens in f32, onto a grid of 1/1024 px.

use crate::Camera;
use nalgebra::{Isometry3, Point3};

/// What is nearer than this is not drawn.
const NEAR_M: f32 = 1e-3;
/// Steps within a pixel.
pub(super) const SUBPIXEL: i32 = 1024;
pub(super) const SUBPIXEL_BITS: u32 = SUBPIXEL.trailing_zeros();

/// A vertex on the picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    /// In steps of 1/1024 px; `NOWHERE` when the lens cannot show it.
    pub u: i32,
    pub v: i32,
    /// 1/z in 1/m.
    pub inverse_depth: f32,
}

/// Where the lens shows nothing.
pub(super) const NOWHERE: i32 = i32::MIN;

/// The camera of one picture, in f32: 1e-4 px at 2000 px of focal length.
pub(super) struct Lens {
    rotation: [[f32; 3]; 3],
    translation: [f32; 3],
    focal: [f32; 2],
    centre: [f32; 2],
    distortion: [f32; 5],
    /// Beyond this ideal radius (squared) the lens shows nothing, and its polynomial may fold back.
    radius_squared: f32,
}

impl Lens {
    pub fn new(camera: &Camera, camera_from_world: &Isometry3<f64>) -> Self {
        let rotation = camera_from_world.rotation.to_rotation_matrix();
        Self {
            rotation: std::array::from_fn(|i| std::array::from_fn(|j| rotation[(i, j)] as f32)),
            translation: std::array::from_fn(|i| camera_from_world.translation.vector[i] as f32),
            focal: [camera.fx as f32, camera.fy as f32],
            centre: [camera.cx as f32, camera.cy as f32],
            distortion: camera.distortion.map(|k| k as f32),
            radius_squared: farthest_radius(camera).powi(2),
        }
    }

    pub fn in_camera(&self, p_in_world: &Point3<f32>) -> Point3<f32> {
        let axis = |i: usize| {
            let [x, y, z] = self.rotation[i];
            x * p_in_world.x + y * p_in_world.y + z * p_in_world.z + self.translation[i]
        };
        Point3::new(axis(0), axis(1), axis(2))
    }

    pub fn corner(&self, p_in_camera: &Point3<f32>) -> Corner {
        let nowhere = Corner { u: NOWHERE, v: NOWHERE, inverse_depth: 0.0 };
        let inverse_depth = p_in_camera.z.recip();
        let (x, y) = (p_in_camera.x * inverse_depth, p_in_camera.y * inverse_depth);
        let r2 = x * x + y * y;
        // Written so that NaN is refused too.
        if !(p_in_camera.z >= NEAR_M && r2 <= self.radius_squared) {
            return nowhere;
        }
        let [k1, k2, p1, p2, k3] = self.distortion;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
        let yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
        let place = |ideal: f32, axis: usize| self.focal[axis] * ideal + self.centre[axis];
        let [u, v] = [place(xd, 0), place(yd, 1)].map(|pixel| pixel * SUBPIXEL as f32);
        const FARTHEST: f32 = (1 << 29) as f32;
        if u.abs() > FARTHEST || v.abs() > FARTHEST {
            return nowhere;
        }
        let snap = |place: f32| if place < 0.0 { (place - 0.5) as i32 } else { (place + 0.5) as i32 };
        Corner { u: snap(u), v: snap(v), inverse_depth }
    }

    /// How long an edge is: on the picture (along the longer axis, as in `is_small`), else by metres, beyond any such.
    pub fn edge(&self, a: &(Point3<f32>, Corner), b: &(Point3<f32>, Corner)) -> f32 {
        if a.1.u == NOWHERE || b.1.u == NOWHERE {
            const FARTHER: f32 = 1e12;
            return FARTHER * (1.0 + (a.0 - b.0).norm());
        }
        a.1.u.abs_diff(b.1.u).max(a.1.v.abs_diff(b.1.v)) as f32
    }

    /// All corners on the outer side of one plane that bounds the view.
    pub fn sees_nothing_of(&self, corners: [&Point3<f32>; 3], width: usize, height: usize) -> bool {
        let radius = self.radius_squared.sqrt() * BOUND;
        let outside = |[x, y]: [f32; 2]| corners.iter().all(|p| x * p.x + y * p.y > radius * p.z);
        if corners.iter().all(|p| p.z < NEAR_M) || BOUNDS.into_iter().any(outside) {
            return true;
        }
        let shown = corners.map(|p| self.corner(p));
        let beyond = |outside: &dyn Fn(&Corner) -> bool| shown.iter().all(|c| c.u != NOWHERE && outside(c));
        // A bent edge bulges by less than this beyond its corners, once it is short enough to matter.
        const MARGIN: i32 = 64 * SUBPIXEL;
        let last = |size: usize| (size as i32).saturating_mul(SUBPIXEL).saturating_add(MARGIN);
        beyond(&|c| c.u < -MARGIN)
            || beyond(&|c| c.v < -MARGIN)
            || beyond(&|c| c.u > last(width))
            || beyond(&|c| c.v > last(height))
    }
}

/// Directions of the planes around the view: a polygon of 16 sides...
const BOUNDS: [[f32; 2]; 16] = {
    const A: f32 = 0.923_879_5; // cos 22.5 degrees
    const B: f32 = 0.382_683_43;
    const C: f32 = std::f32::consts::FRAC_1_SQRT_2;
    [
        [1.0, 0.0],
        [A, B],
        [C, C],
        [B, A],
        [0.0, 1.0],
        [-B, A],
        [-C, C],
        [-A, B],
        [-1.0, 0.0],
        [-A, -B],
        [-C, -C],
        [-B, -A],
        [0.0, -1.0],
        [B, -A],
        [C, -C],
        [A, -B],
    ]
};
/// ... whose corners still lie inside the circle that the lens shows (cos 11.25 degrees, rounded down).
const BOUND: f32 = 0.98;

/// The ideal radius (units of the focal length) that shows a tenth beyond the farthest corner, or the last before the
/// lens folds back.
fn farthest_radius(camera: &Camera) -> f32 {
    const BEYOND: f64 = 1.1;
    let reach = |focal: f64, centre: f64, size: u32| centre.abs().max((f64::from(size) - centre).abs()) / focal;
    let corner =
        reach(camera.fx, camera.cx, camera.width).hypot(reach(camera.fy, camera.cy, camera.height)) * BEYOND + 0.05;
    let [k1, k2, _, _, k3] = camera.distortion;
    const STEPS: usize = 1000;
    let mut last = 0.0;
    for step in 1..=4 * STEPS {
        let r = corner * step as f64 / STEPS as f64;
        let r2 = r * r;
        let slope = 1.0 + r2 * (3.0 * k1 + r2 * (5.0 * k2 + r2 * 7.0 * k3));
        if slope <= 0.0 {
            break;
        }
        last = r;
        if r * (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) >= corner {
            break;
        }
    }
    last as f32
}
