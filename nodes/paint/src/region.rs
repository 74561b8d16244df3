//! The working region: the part of the picture near the optical axis (paper, section 2.6).

use crate::Config;
use geometry::Camera;
use nalgebra::{Point2, Point3};

/// A rectangle of the picture around all lines of sight within some angle of the optical axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// First column of the whole picture.
    pub left: u32,
    /// First row of the whole picture.
    pub top: u32,
    /// The camera that would take just this part.
    pub camera: Camera,
    /// Size of the whole picture.
    pub whole: [u32; 2],
    /// Cosine of the angle.
    pub axis_cosine: f32,
    /// Largest angle of a line of sight in the rectangle: its corners look past the cone.
    pub corner_rad: f64,
}

/// The optical axis misses the picture by more than the working angle.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "no pixel of the picture looks within {axis_degrees} degrees of the optical axis: check cx, cy or axis_degrees"
)]
pub struct NoRegion {
    /// The angle.
    pub axis_degrees: f64,
}

impl Region {
    /// The region of a camera.
    pub fn of(camera: &Camera, config: &Config) -> Result<Self, NoRegion> {
        let angle = config.axis_degrees.to_radians();
        const STEPS: usize = 72;
        let circle = (0..STEPS).filter_map(|step| {
            let turn = std::f64::consts::TAU * step as f64 / STEPS as f64;
            camera.project(&Point3::new(angle.tan() * turn.cos(), angle.tan() * turn.sin(), 1.0))
        });
        let far = Point2::new(f64::INFINITY, f64::INFINITY);
        let (low, high) = circle.fold((far, -far), |(low, high), p| (low.inf(&p), high.sup(&p)));
        let clip = |from: f64, to: f64, size: u32| {
            let (from, to) = (from.floor().max(0.0), (to.ceil() + 1.0).min(f64::from(size)));
            (to > from).then_some((from as u32, (to - from) as u32))
        };
        let none = NoRegion { axis_degrees: config.axis_degrees };
        let (Some((left, width)), Some((top, height))) =
            (clip(low.x, high.x, camera.width), clip(low.y, high.y, camera.height))
        else {
            return Err(none);
        };
        let (cx, cy) = (camera.cx - f64::from(left), camera.cy - f64::from(top));
        let cropped = Camera { width, height, cx, cy, ..*camera };
        let corner_rad = [(0, 0), (width, 0), (0, height), (width, height)]
            .map(|(u, v)| cropped.direction(Point2::new(f64::from(u), f64::from(v))))
            .map(|direction| direction.x.hypot(direction.y).atan())
            .into_iter()
            .fold(angle, f64::max);
        let whole = [camera.width, camera.height];
        Ok(Self { left, top, camera: cropped, whole, axis_cosine: angle.cos() as f32, corner_rad })
    }
}
