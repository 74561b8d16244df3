//! Profiles and poses to points in the world, live (paper, section 2.3: R(t) x + p(t)).
//!
//! In: [`wire::Profile`], points in the frame of the camera, and [`wire::Pose`], readings of the tracker. Out:
//! [`wire::Scan`], the points in the world with the direction to the sensor and their sigma; and [`wire::Trajectory`],
//! world_from_camera at each accepted reading, on the camera's clock; smooth, and 0.3 s behind.
//!
//! A profile waits until its pose is known; world_from_camera = world_from_body body_from_camera. A reading's stamp plus
//! the rig's pose offset is the camera's clock. Position and rotation may have been sampled at different moments
//! (`rotation_lag_nanos`): each is taken at its own.
//!
//! The pose is the one of a smooth way through the readings ([`geometry::smooth`]), which finds out by itself how noisy
//! the tracker is. It is known once there is a reading [`Config::smooth_lag_ms`] behind the profile, or up to
//! [`Config::predict_ms`] before it when those readings tell it better than the next would. The stamps alone decide, so
//! it does not matter when and in which batches messages come. A scan's sigmas are the smooth pose's: the white noise that
//! is left, and what the tracker states beyond it. Before the noise is known (16 readings), and with [`Config::smooth`]
//! off, the pose is interpolated between the two readings around the profile, on the shorter arc
//! (geometry::interpolate).
//!
//! The wait is bounded by [`Config::most_waiting`] and [`Config::most_wait_ms`]. What gets no pose is refused, and the
//! next scan says how many for which reason; nothing is dropped unsaid. Readings are kept for ten minutes, so poses and
//! profiles may come in any order between the two streams: a node that starts in mid-scan gets all of both at once.
//!
//! A higher scan number starts afresh. Profiles of phase `Aim` are refused: while aiming nothing is kept.
//!
//! ```
//! use register::{Config, Register};
//! use wire::*;
//! # let camera = CameraIntrinsics { width: 640, height: 480, fx: 800.0, fy: 800.0, cx: 319.5, cy: 239.5, distortion: [0.0; 5] };
//! # let laser = LaserPlane { normal: [-0.8, 0.0, 0.6], distance_m: 0.1, channel_weights: [1.0; 3], peaks_per: PeaksPer::Row };
//! # let calibration = Calibration { header: Header::default(), camera, laser, body_from_camera: RigidPose::IDENTITY, pose_offset_nanos: 0, name: "x".into() };
//! let mut register = Register::new(Config::default(), &calibration).unwrap();
//! let header = |stamp_nanos| Header { stamp_nanos, phase: Phase::Shape, ..Header::default() };
//! let pose = |stamp, x| Pose {
//!     header: header(stamp), world_from_body: RigidPose { translation_m: [x, 0.0, 0.0], ..RigidPose::IDENTITY },
//!     position_sigma_m: [1e-3; 3], rotation_sigma_rad: [0.01; 3], rotation_lag_nanos: 0, quality: Quality::Good, reason: String::new(),
//! };
//! register.pose(&pose(0, 0.0));
//! let point = ProfilePoint { position_m: [0.0, 0.0, 0.2], range_sigma_m: 1e-4, ..Default::default() };
//! register.profile(Profile { header: header(5_000_000), points: vec![point].into(), refused: vec![] });
//! assert!(register.drain().next().is_none(), "it waits for the reading behind it");
//! register.pose(&pose(10_000_000, 0.1));
//! let scan = register.drain().next().unwrap();
//! assert!((scan.points[0].position_m[0] - 0.05).abs() < 1e-6);
//! ```

mod between;
mod config;
#[cfg(feature = "node")]
pub mod node;
mod place;
mod readings;
mod register;

pub use config::{Config, ConfigError};
pub use register::{Register, RegisterError};
