//! What travels between the nodes: one file a message.
//!
//! A message is a plain struct that begins with a [`Header`]. [`topic`] is the only place where a key is spelled,
//! [`codec`] the only file that names the encoding. Nothing here knows how a message travels (crate `bus`) or what
//! space is (crate `geometry`): poses and points are numbers in named fields.
//!
//! Units are SI (metres, radians, nanoseconds); pixels have `u` to the right and `v` down, and (0, 0) is the centre of
//! the top-left pixel. A rotation is a unit quaternion in the order w, x, y, z.
//!
//! ```
//! use wire::{codec, Header, Pose, Quality, RigidPose};
//! let pose = Pose {
//!     header: Header::default(),
//!     world_from_body: RigidPose::IDENTITY,
//!     position_sigma_m: [1e-3; 3],
//!     rotation_sigma_rad: [0.05; 3],
//!     rotation_lag_nanos: 0,
//!     quality: Quality::Good,
//!     reason: String::new(),
//! };
//! let bytes = codec::encode(&pose);
//! assert_eq!(codec::decode::<Pose>(&bytes).unwrap(), pose);
//! ```

mod bulk;
mod calibration;
mod catalogue;
mod cloud;
pub mod codec;
mod frame;
mod header;
mod housekeeping;
mod latency;
mod layout;
mod mesh;
mod model;
mod pose;
mod profile;
mod refinement;
mod scan;
mod stripe;
pub mod topic;
mod trajectory;
mod ycbcr;

pub use bulk::Bulk;
pub use calibration::{Calibration, CameraIntrinsics, LaserPlane, PeaksPer};
pub use catalogue::{catalogue, layout_text};
pub use cloud::{Cloud, CloudPoint, Extent, TablePlane};
pub use frame::{Frame, FrameError, Light, PixelFormat};
pub use header::{Clock, Header, Phase, Refusal, RunPhase};
pub use housekeeping::{Health, InputHealth, LogLevel, LogLine, Progress};
pub use latency::Latencies;
pub use layout::{Layout, Message, fold, fold_str};
pub use mesh::Mesh;
pub use model::Model;
pub use pose::{Pose, Quality, RigidPose};
pub use profile::{Profile, ProfilePoint};
pub use refinement::{FrameFit, Observed, Refinement, TrackerFit};
pub use scan::{Scan, ScanPoint};
pub use stripe::{Stripe, StripePeak};
pub use trajectory::{Trajectory, TrajectorySample};
pub use ycbcr::YCbCr;

#[cfg(target_endian = "big")]
compile_error!("bulk arrays travel as little-endian bytes; a big-endian machine would need a swap in bulk.rs");
