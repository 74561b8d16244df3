//! Camera ray with laser sheet: from peaks in the picture to points in the frame of the camera (paper, section 2.2).
//!
//! In: [`wire::Stripe`], peaks in distorted pixels with their sigma. Out: [`wire::Profile`], points x in metres with one
//! standard deviation along and across the ray, in the order of the stripe, and the peaks that gave none, by reason.
//!
//! A peak at pixel (i, j) lies on the ray c + mu v(i, j), with c the camera's centre at the origin and v the undistorted
//! direction, scaled to z = 1. The sheet is n . x = d. So mu = d / (n . v), and x = mu v ([`Triangulator::process`]).
//!
//! The error of a peak across the stripe moves v, and with it mu: to first order d mu = -mu (n . dv) / (n . v), and the
//! range mu |v| by d mu |v| + mu (v . dv) / |v|.
//! Near a ray that runs along the sheet this grows without bound; such peaks are refused by angle. The laser plane's own
//! error is not part of the sigma: it is the same for all points and shows in no scatter.
//!
//! Directions come from a table over the picture with bilinear interpolation ([`directions`]), as fine as the lens needs
//! for a thousandth of a pixel; Newton on every peak would cost ten times as much.
//!
//! ```
//! use triangulate::{Config, Triangulator};
//! use wire::*;
//! let camera = CameraIntrinsics { width: 640, height: 480, fx: 800.0, fy: 800.0, cx: 319.5, cy: 239.5, distortion: [0.0; 5] };
//! // A sheet that crosses the axis at 0.2 m, tilted by 30 degrees.
//! let laser = LaserPlane { normal: [-0.75f64.sqrt(), 0.0, 0.5], distance_m: 0.1, channel_weights: [1.0, 0.0, 0.0], peaks_per: PeaksPer::Row };
//! let header = Header::default();
//! let calibration = Calibration { header, camera, laser, body_from_camera: RigidPose::IDENTITY, pose_offset_nanos: 0, name: "x".into() };
//! let mut triangulator = Triangulator::new(Config::default(), &calibration).unwrap();
//! let peak = StripePeak { u_px: 319.5, v_px: 239.5, sigma_px: 0.1, amplitude: 90.0, width_px: 1.5, flags: StripePeak::BEST };
//! let light = Light { laser: true, lamp: false };
//! let profile = triangulator.process(&Stripe { header, width: 640, height: 480, light, peaks: vec![peak].into(), refused: vec![] });
//! assert!((profile.points[0].position_m[2] - 0.2).abs() < 1e-6);
//! assert!((profile.points[0].range_sigma_m - 0.1 / 800.0 * 0.2 * 3f32.sqrt()).abs() < 1e-7);
//! ```

mod config;
pub mod directions;
#[cfg(feature = "node")]
pub mod node;
mod triangulator;

pub use config::{Config, ConfigError};
pub use triangulator::{Triangulator, TriangulatorError};
