//! Where the pictures are taken from.

use geometry::{Camera, TriangleMesh};
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// A picture to be taken: a camera without distortion, and where it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The lens.
    pub camera: Camera,
    /// Where it stands.
    pub camera_from_world: Isometry3<f64>,
}

const AZIMUTHS_DEG: [f64; 4] = [-55.0, 35.0, 125.0, 215.0];
const ELEVATION_DEG: f64 = 24.0;
/// From there one sees what stood on the table.
const BELOW_DEG: f64 = -40.0;
/// In radii of the thing: far enough that near parts do not look swollen.
const DISTANCE: f64 = 7.0;
/// The share of the picture that the thing fills.
const FILL: f64 = 0.94;

/// Four views from all sides, a little from above (z up), at one scale, in each of which the mesh fills the picture as far
/// as its largest view allows. Empty for a mesh without vertices.
pub fn four_views(mesh: &TriangleMesh, width: u32, height: u32) -> Vec<View> {
    views_at(ELEVATION_DEG, mesh, width, height)
}

/// The same from below.
pub fn four_views_from_below(mesh: &TriangleMesh, width: u32, height: u32) -> Vec<View> {
    views_at(BELOW_DEG, mesh, width, height)
}

fn views_at(elevation_deg: f64, mesh: &TriangleMesh, width: u32, height: u32) -> Vec<View> {
    let Some([low, high]) = mesh.bounds().map(|b| b.map(|p| p.map(f64::from))) else { return Vec::new() };
    let middle = nalgebra::center(&low, &high);
    let radius = (0.5 * (high - low).norm()).max(1e-6);
    let standing = AZIMUTHS_DEG.map(|azimuth| stand(&middle, DISTANCE * radius, [azimuth, elevation_deg]));
    let boxes = standing.map(|camera_from_world| ideal_bounds(mesh, &camera_from_world));
    let fits = |[[left, top], [right, bottom]]: [[f64; 2]; 2]| {
        let across = f64::from(width) / (right - left).max(1e-9);
        let down = f64::from(height) / (bottom - top).max(1e-9);
        FILL * across.min(down)
    };
    let focal = boxes.iter().map(|&b| fits(b)).fold(f64::INFINITY, f64::min);
    let view = |(camera_from_world, [[left, top], [right, bottom]]): (Isometry3<f64>, [[f64; 2]; 2])| {
        let cx = 0.5 * (f64::from(width) - 1.0) - focal * 0.5 * (left + right);
        let cy = 0.5 * (f64::from(height) - 1.0) - focal * 0.5 * (top + bottom);
        View { camera: Camera { width, height, fx: focal, fy: focal, cx, cy, distortion: [0.0; 5] }, camera_from_world }
    };
    standing.into_iter().zip(boxes).map(view).collect()
}

impl View {
    /// The same view with `times` as many pixels in each direction.
    pub fn enlarged(&self, times: u32) -> Self {
        let Camera { width, height, fx, fy, cx, cy, distortion } = self.camera;
        let k = f64::from(times);
        let centre = |c: f64| k * (c + 0.5) - 0.5;
        let (cx, cy) = (centre(cx), centre(cy));
        let camera =
            Camera { width: width * times, height: height * times, fx: k * fx, fy: k * fy, cx, cy, distortion };
        Self { camera, ..*self }
    }
}

/// camera_from_world of a camera that looks at `target`, with the world's z upright in the picture.
fn stand(target: &Point3<f64>, distance_m: f64, direction_deg: [f64; 2]) -> Isometry3<f64> {
    let [azimuth, elevation] = direction_deg.map(f64::to_radians);
    let towards = Vector3::new(elevation.cos() * azimuth.cos(), elevation.cos() * azimuth.sin(), elevation.sin());
    let forward = -towards;
    let right = forward.cross(&Vector3::z()).normalize();
    let down = forward.cross(&right);
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[right, down, forward]));
    let place = Translation3::from(target.coords + towards * distance_m);
    Isometry3::from_parts(place, UnitQuaternion::from_rotation_matrix(&rotation)).inverse()
}

/// Left top and right bottom of the mesh, in units of the focal length.
fn ideal_bounds(mesh: &TriangleMesh, camera_from_world: &Isometry3<f64>) -> [[f64; 2]; 2] {
    let empty = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    mesh.vertices.iter().fold(empty, |[low, high], p| {
        let q = camera_from_world * p.map(f64::from);
        let [x, y] = [q.x / q.z, q.y / q.z];
        [[low[0].min(x), low[1].min(y)], [high[0].max(x), high[1].max(y)]]
    })
}
