//! The way of the camera made consistent with the surface that it saw (paper, section 6, second point).
//!
//! A tracker that is 3 degrees wrong puts points a centimetre off; but surface that was seen twice must be one surface. In:
//! [`wire::Profile`], points in the frame of the camera; [`wire::Pose`], the tracker's readings; [`wire::Calibration`].
//! Out: a [`Refinement`], that is world_from_camera at any moment, [`wire::Scan`]s whose sigma has the pose's in it, and
//! [`Evidence`]. [`Refiner::tick`] refines while the scan goes on, [`Refiner::finish`] when it is over.
//!
//! # Method
//!
//! The tracker is smoothed (`geometry::SmoothTrajectory`), and a correction is added: a spline with knots of 33 ms for
//! the hand's tremor that was smoothed away, one of 100 ms for what is left of the tracker's white noise, one with slow
//! knots for errors that last, a polynomial in space for the field of the room, the hand-eye transform and the clock
//! offset (`unknowns`). All of them are found at once by Gauss-Newton steps. A point's residual is its distance from
//! the quadric through its neighbours of all times, seen from the same side (`surfel`, `quadric`; Geman-McClure
//! weights). The quadrics' own parameters are eliminated exactly (`schur`), or what was scanned first would hold its
//! errors fast; this is bundle adjustment with surface patches for landmarks (Triggs et al. 2000; for planes Liu and
//! Zhang 2021, "BALM"). The system is never formed: conjugate gradients multiply by it surfel by surfel (`pcg`,
//! `precondition`). Where the thing stands on a flat table, all strokes that saw it agree by it (`table`). The schedule
//! goes from surfels of 14 mm to 5 mm (`schedule`). The smoothed tracker stands for all readings in the prior (`prior`).
//! In the end the whole is laid rigidly onto the smoothed tracker's cloud (`gauge`):
//! where the scan lies in the world no surface tells. How far whole regions may still stand off, as no overlap tells, is
//! drawn from what the scan leaves open (`posterior`) and goes with each frame ([`wire::Scan::region_sigma_m`]; 0 in live
//! revisions, which do not ask).
//!
//! # Guards
//!
//! The hand-eye transform is freed only where stripes cross. Noise that is not white shows by corrections larger than the
//! prior allows (`guard::coloured`); then all begins again with a prior that believes the readings less. Frames that fit nowhere, or that
//! nothing holds, are dropped and told; a stroke that is missing is named while the hand still moves. A step that makes things worse is taken back; a refinement that fits no better
//! than the smoothed tracker is not given out, the smoothed one is. A thing that was moved is noticed, with the moment. What is noticed
//! stands in [`Evidence::notices`].
//!
//! # Limits
//!
//! Sliding along a surface without shape stays (a plane holds nothing); where the whole scan lies is no better known than
//! the tracker's slow errors allow; an error of the laser's plane is not seen. A scan needs overlap: strokes that cross, some ten
//! seconds of them. All frames' points are kept in memory, 28 bytes each.
//!
//! Metres, radians, nanoseconds; twists are (translation, rotation) along the axes of the body. The same messages and
//! seed give the same bytes on any number of threads.
//!
//! ```
//! use refine::{Config, RefineError, Refiner};
//! # use wire::*;
//! # let camera = CameraIntrinsics { width: 640, height: 480, fx: 800.0, fy: 800.0, cx: 319.5, cy: 239.5, distortion: [0.0; 5] };
//! # let laser = LaserPlane { normal: [-0.8, 0.0, 0.6], distance_m: 0.1, channel_weights: [1.0; 3], peaks_per: PeaksPer::Row };
//! # let calibration = Calibration { header: Header::default(), camera, laser, body_from_camera: RigidPose::IDENTITY, pose_offset_nanos: 0, name: "x".into() };
//! let mut refiner = Refiner::new(Config::default(), &calibration)?;
//! for i in 0..300 {
//!     let stamp_nanos = i * 10_000_000;
//!     let header = Header { stamp_nanos, phase: Phase::Shape, ..Header::default() };
//!     let x = 0.05 * i as f64 * 0.01;
//!     refiner.pose(&Pose {
//!         header, world_from_body: RigidPose { translation_m: [x, 0.0, 0.0], ..RigidPose::IDENTITY },
//!         position_sigma_m: [1e-3; 3], rotation_sigma_rad: [0.01; 3], rotation_lag_nanos: 0,
//!         quality: Quality::Good, reason: String::new(),
//!     });
//!     let point = |k: i32| ProfilePoint {
//!         position_m: [0.0, 0.001 * k as f32, 0.2], range_sigma_m: 1e-4, ..Default::default()
//!     };
//!     refiner.profile(&Profile { header, points: (0..60).map(point).collect(), refused: vec![] });
//! }
//! let refinement = refiner.finish()?;
//! // One stroke over a plane: nothing was seen twice, and it says so.
//! println!("{:?}", refinement.evidence.notices);
//! assert_eq!(refinement.scans().len(), 300);
//! assert!(refinement.scans().all(|scan| (scan.points[0].position_m[2] - 0.2).abs() < 1e-3));
//! # Ok::<(), RefineError>(())
//! ```

mod banded;
#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod checks;
mod clock;
mod cloud;
mod config;
#[cfg(feature = "node")]
mod course;
mod evidence;
mod finish;
mod gather;
mod gauge;
mod guard;
mod judge;
mod live;
#[cfg(feature = "node")]
pub mod node;
mod notices;
mod outcome;
mod pcg;
mod posterior;
mod precondition;
mod prior;
mod quadric;
#[cfg(feature = "node")]
mod readers;
mod refinement;
mod refiner;
mod scene;
mod schedule;
mod schur;
mod seen_through;
mod sentence;
mod shown;
mod solver;
mod spline;
mod step;
mod surfel;
mod system;
mod table;
#[cfg(feature = "node")]
mod tell;
mod testimony;
mod tracker;
mod unknowns;
mod watch;
#[cfg(feature = "node")]
mod worker;

pub use config::{Config, ConfigError};
pub use evidence::{
    ClockEvidence, DropReason, DroppedFrame, Evidence, FrameEvidence, HandEyeEvidence, Notice, Observed, RefusedInput,
    Residual, TrackerEvidence,
};
pub use refinement::Refinement;
pub use refiner::{RefineError, Refiner};
pub use sentence::sentence;
pub use shown::Shown;
