//! What the hand holds, as it is drawn: a box from camera to laser, and the sheet of light. In the frame of the camera.

use nalgebra::{Point3, Vector3};
use wire::LaserPlane;

/// As far as the paper's handset works (section 3): a line of 12 cm at 20 cm.
const REACH_M: f64 = 0.2;
const HALF_LINE_M: f64 = 0.06;
/// Around camera and laser: to the sides of the line between them, and behind them.
const MARGIN_M: f64 = 0.018;
const DEPTH_M: f64 = 0.045;

/// The handset's shapes, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Handset {
    /// Middle and half sizes of the box.
    pub housing: [[f32; 3]; 2],
    /// The sheet: where it leaves the laser, and both ends of its line.
    pub sheet: [[f32; 3]; 3],
}

/// Of a calibrated laser; `None` for a sheet across the camera's axis, which comes from no laser beside the camera.
pub fn handset(laser: &LaserPlane) -> Option<Handset> {
    let normal = Vector3::from(laser.normal);
    let across = Vector3::new(normal.x, normal.y, 0.0);
    let square = across.norm_squared();
    if !(square > 1e-6 && laser.distance_m.is_finite()) {
        return None;
    }
    // The place of the sheet that is nearest to the camera's axis, at a depth.
    let at = |z: f64| Point3::from(across * ((laser.distance_m - normal.z * z) / square)) + Vector3::z() * z;
    let along = normal.cross(&Vector3::z()).normalize() * HALF_LINE_M;
    let (exit, line) = (at(0.0), at(REACH_M));
    let place = |p: Point3<f64>| <[f32; 3]>::from(p.cast::<f32>());
    let half = exit.coords.abs() * 0.5 + Vector3::new(MARGIN_M, MARGIN_M, 0.5 * DEPTH_M);
    let middle = Point3::from(exit.coords * 0.5) - Vector3::z() * (0.5 * DEPTH_M);
    Some(Handset {
        housing: [place(middle), half.cast::<f32>().into()],
        sheet: [place(exit), place(line - along), place(line + along)],
    })
}
