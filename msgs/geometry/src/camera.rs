//! The camera: pinhole with Brown-Conrady distortion (paper, section 2.2: c and v(i, j); Brown 1971, the order of the
//! coefficients as in OpenCV: k1, k2, p1, p2, k3).

use nalgebra::{Matrix2, Point2, Point3, Vector3};
use serde::{Deserialize, Serialize};

/// Where each pixel looks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Focal length in pixels, along u.
    pub fx: f64,
    /// Focal length in pixels, along v.
    pub fy: f64,
    /// Principal point, u.
    pub cx: f64,
    /// Principal point, v.
    pub cy: f64,
    /// k1, k2, p1, p2, k3.
    #[serde(default)]
    pub distortion: [f64; 5],
}

/// Optics that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// A number is not finite or has the wrong sign.
    #[error("[camera] {name} = {value}: {wanted}")]
    Value {
        /// The key.
        name: &'static str,
        /// What it holds.
        value: f64,
        /// What it should hold.
        wanted: &'static str,
    },
    /// The distortion folds the picture over.
    #[error(
        "[camera] distortion {distortion:?} folds the picture at {radius_px:.0} px from the principal point, inside the \
         {width}x{height} picture; check the order k1, k2, p1, p2, k3"
    )]
    Folds {
        /// The coefficients.
        distortion: [f64; 5],
        /// Where the picture turns back.
        radius_px: f64,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
}

/// Newton stops when a step is shorter than this, in units of the focal length (1e-12 is 1e-9 px).
const UNDISTORT_STEP: f64 = 1e-12;
const UNDISTORT_ITERATIONS: usize = 20;

impl Camera {
    /// Refuses optics that cannot be.
    pub fn check(&self) -> Result<(), CameraError> {
        let value = |name, value: f64, wanted| Err(CameraError::Value { name, value, wanted });
        for (name, size) in [("width", self.width), ("height", self.height)] {
            if !(8..=16384).contains(&size) {
                return value(name, f64::from(size), "8 to 16384 pixels are understood");
            }
        }
        for (name, focal) in [("fx", self.fx), ("fy", self.fy)] {
            if !focal.is_finite() || focal < 1.0 {
                return value(name, focal, "a focal length is at least 1 pixel");
            }
        }
        for (name, centre) in [("cx", self.cx), ("cy", self.cy)] {
            if !centre.is_finite() {
                return value(name, centre, "must be finite");
            }
        }
        if let Some(bad) = self.distortion.iter().find(|k| !k.is_finite()) {
            return value("distortion", *bad, "must be finite");
        }
        self.check_fold()
    }

    /// The radial part must grow monotonically out to the farthest corner, or two rays share a pixel.
    fn check_fold(&self) -> Result<(), CameraError> {
        let corner = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
            .iter()
            .map(|(i, j)| {
                let x = (i * f64::from(self.width) - self.cx) / self.fx;
                let y = (j * f64::from(self.height) - self.cy) / self.fy;
                x.hypot(y)
            })
            .fold(0.0, f64::max);
        let [k1, k2, _, _, k3] = self.distortion;
        const STEPS: usize = 400;
        for step in 1..=2 * STEPS {
            let r = corner * step as f64 / STEPS as f64;
            let r2 = r * r;
            let distorted = r * (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3)));
            let slope = 1.0 + r2 * (3.0 * k1 + r2 * (5.0 * k2 + r2 * 7.0 * k3));
            if slope <= 0.0 {
                return Err(CameraError::Folds {
                    distortion: self.distortion,
                    radius_px: distorted.abs() * self.fx,
                    width: self.width,
                    height: self.height,
                });
            }
            if distorted >= corner {
                break;
            }
        }
        Ok(())
    }

    /// Distorted from ideal image coordinates (both in units of the focal length), with the Jacobian.
    fn distort(&self, x: f64, y: f64) -> ([f64; 2], Matrix2<f64>) {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        let slope = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3); // d radial / d r2
        let xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
        let yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
        let cross = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
        let jacobian = Matrix2::new(
            radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x,
            cross,
            cross,
            radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x,
        );
        ([xd, yd], jacobian)
    }

    /// The pixel of a point in front of the camera; `None` behind it.
    pub fn project(&self, p_in_camera: &Point3<f64>) -> Option<Point2<f64>> {
        if p_in_camera.z <= 0.0 {
            return None;
        }
        let ([x, y], _) = self.distort(p_in_camera.x / p_in_camera.z, p_in_camera.y / p_in_camera.z);
        Some(Point2::new(self.fx * x + self.cx, self.fy * y + self.cy))
    }

    /// The viewing direction v(i, j) of a pixel, scaled to z = 1 (Newton on the distortion).
    pub fn direction(&self, pixel: Point2<f64>) -> Vector3<f64> {
        let target = [(pixel.x - self.cx) / self.fx, (pixel.y - self.cy) / self.fy];
        let [mut x, mut y] = target;
        if self.distortion != [0.0; 5] {
            for _ in 0..UNDISTORT_ITERATIONS {
                let ([xd, yd], jacobian) = self.distort(x, y);
                let Some(inverse) = jacobian.try_inverse() else { break };
                let step = inverse * nalgebra::Vector2::new(target[0] - xd, target[1] - yd);
                x += step.x;
                y += step.y;
                if step.norm() < UNDISTORT_STEP {
                    break;
                }
            }
        }
        Vector3::new(x, y, 1.0)
    }

    /// True when a pixel lies on the picture (pixel centres are whole numbers).
    pub fn contains(&self, pixel: &Point2<f64>) -> bool {
        pixel.x >= -0.5
            && pixel.y >= -0.5
            && pixel.x < f64::from(self.width) - 0.5
            && pixel.y < f64::from(self.height) - 0.5
    }
}

impl From<&wire::CameraIntrinsics> for Camera {
    fn from(c: &wire::CameraIntrinsics) -> Self {
        let wire::CameraIntrinsics { width, height, fx, fy, cx, cy, distortion } = *c;
        Self { width, height, fx, fy, cx, cy, distortion }
    }
}

impl From<&Camera> for wire::CameraIntrinsics {
    fn from(c: &Camera) -> Self {
        let Camera { width, height, fx, fy, cx, cy, distortion } = *c;
        Self { width, height, fx, fy, cx, cy, distortion }
    }
}
