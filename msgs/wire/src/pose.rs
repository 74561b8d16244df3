//! Where the handset is, when, and how well that is known (paper, section 2.3: R and p).

use crate::Header;
use crate::layout::{layout, message};

layout! {
    /// A rigid transform `a_from_b`: p_in_a = R p_in_b + t.
    #[derive(Copy)]
    pub struct RigidPose {
        /// t, in metres.
        pub translation_m: [f64; 3],
        /// R as a unit quaternion w, x, y, z.
        pub rotation_wxyz: [f64; 4],
    }
}

impl RigidPose {
    /// Nothing moves.
    pub const IDENTITY: Self = Self { translation_m: [0.0; 3], rotation_wxyz: [1.0, 0.0, 0.0, 0.0] };
}

layout! {
    /// What the tracker says of its own reading.
    pub enum Quality {
        /// As its data sheet promises.
        Good,
        /// Usable, with a larger sigma: the reason says why.
        Degraded,
        /// Not usable.
        Lost,
    }
}

layout! {
    /// One reading of the tracker.
    pub struct Pose {
        /// `stamp_nanos` is the tracker's moment of sampling the position.
        pub header: Header,
        /// The receiver on the handset (`body`) in the frame of the tracker's base (`world`).
        pub world_from_body: RigidPose,
        /// One standard deviation along the axes of the world.
        pub position_sigma_m: [f64; 3],
        /// One standard deviation about the axes of the body.
        pub rotation_sigma_rad: [f64; 3],
        /// How much older the rotation is than the position.
        pub rotation_lag_nanos: i64,
        /// Whether it may be used.
        pub quality: Quality,
        /// Why the quality is not good; empty when it is.
        pub reason: String,
    }
}
message!(Pose @ 1);

impl Pose {
    /// No reading: what goes behind the last one, and why there is none.
    pub fn none(header: Header, reason: &str) -> Self {
        Self {
            header,
            world_from_body: RigidPose::IDENTITY,
            position_sigma_m: [0.0; 3],
            rotation_sigma_rad: [0.0; 3],
            rotation_lag_nanos: 0,
            quality: Quality::Lost,
            reason: reason.to_owned(),
        }
    }
}
