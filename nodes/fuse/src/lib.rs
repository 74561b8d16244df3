//! Several receivers on one handset make one pose, better turned than any of them (paper, section 6, first point).
//!
//! In: [`wire::Pose`] of each receiver, `tracker/<receiver>/pose`, and where it sits on the handset, [`Receiver`]. Out:
//! [`wire::Pose`] of the body, `tracker/<instance>/pose`, as if one better tracker had told it.
//!
//! It stands before `register` rather than in it because `register` and `refine` both read the tracker, and a recording
//! keeps it: all of them take the fused pose as they take any other, and none knows how many receivers there are.
//!
//! - The pose is the least-squares one of all receivers' positions and rotations, each with the weight of its sigma. A
//!   tracker of 1.5 mm and 3 degrees tells 10 cm of arm to a fraction of a degree, so most of the orientation comes from
//!   where the receivers are. About the line through receivers that stand in a row only their own rotations tell; the
//!   sigma about each axis says so.
//! - The moments are the readings of the first receiver in the list; where it tells no pose, those of the next. Not all
//!   readings of all: between two of its readings a receiver's pose is interpolated, so neighbouring moments would share
//!   their noise, and whoever smooths would take it for motion. Position and rotation are each taken at their own moment
//!   (`rotation_lag_nanos`); the fused rotation is as old as the position.
//! - Receivers that contradict each other: the one without which the others agree best is left out, as long as more than
//!   half agree; else there is no pose, for which of two is wrong cannot be told.
//! - A receiver that is lost, late or silent is left out and named: the pose is then degraded, with the larger sigma and
//!   the reason. The stamps decide, so it does not matter when and in which batches messages come; but for who keeps the
//!   others waiting ([`Fuse::overdue`]), where a clock on the wall has the last word. It is waited for again as soon as it
//!   has caught up.
//!
//! What the sigmas hold: the noise that each receiver states, and [`Config::apart_mm`] and [`Config::apart_deg`], by which
//! each may be off on its own. **What they do not hold, because it does not average out**: errors that all receivers
//! share. A room's bent field moves and turns the whole handset; over an arm of 10 cm it is nearly the same for all, and
//! three receivers are as wrong in it as one. The same holds for the base, the latency and the clock. All receivers must be
//! on one clock.
//!
//! Limits. The sigmas go out along the axes alone, without the correlations between them. An interpolated reading has less
//! noise than it states (down to 0.7 half-way), and shares some with its neighbour. A moment waits until each receiver has
//! a reading behind it: up to the time between two readings. Within a scan time does not go backwards: a clock that was
//! set back is heard again in the next.
//!
//! ```
//! use fuse::{Config, Fuse, Receiver};
//! use wire::*;
//! let at = |tracker: &str, x: f64| Receiver { tracker: tracker.into(), translation_m: [x, 0.0, 0.0], rotation_wxyz: [1.0, 0.0, 0.0, 0.0] };
//! let receivers = vec![at("left", -0.1), at("right", 0.1)];
//! let mut fuse = Fuse::new(Config { receivers, ..Config::default() })?;
//! let pose = |y: f64, x: f64| Pose {
//!     header: Header { phase: Phase::Both, ..Header::default() },
//!     world_from_body: RigidPose { translation_m: [x, y, 0.0], ..RigidPose::IDENTITY },
//!     position_sigma_m: [1e-3; 3], rotation_sigma_rad: [0.05; 3], rotation_lag_nanos: 0, quality: Quality::Good, reason: String::new(),
//! };
//! fuse.pose(0, &pose(-0.001, -0.1));
//! assert!(fuse.drain().next().is_none(), "the other has not told of this moment");
//! fuse.pose(1, &pose(0.001, 0.1));
//! let fused = fuse.drain().next().ok_or("no pose")?;
//! // Between them 0.2 m, and 2 mm across: 0.01 rad about z, of which their own rotations know nothing.
//! let [w, _, _, z] = fused.world_from_body.rotation_wxyz;
//! assert!((2.0 * z.atan2(w) - 0.01).abs() < 1e-3 && fused.rotation_sigma_rad[2] < 0.011);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod agree;
mod config;
mod evidence;
mod fuse;
mod moment;
#[cfg(feature = "node")]
pub mod node;
mod solve;
mod tell;
mod track;

pub use config::{Config, ConfigError, Receiver};
pub use evidence::Evidence;
pub use fuse::Fuse;
