//! What a refinement says of itself.

use crate::layout::{element, layout, message};
use crate::{Bulk, Header};

element! {
    /// How one frame fits the surface that all frames agree on.
    pub struct FrameFit {
        /// The frame's.
        pub stamp_nanos: i64,
        /// Four in five of its points are closer to the surface; NaN when no other frame saw it.
        pub residual_m: f32,
        /// One standard deviation of its points along their rays, as far as the pose goes.
        pub sigma_m: f32,
    }
}

layout! {
    /// What a scan determines, whatever its tracker.
    pub struct Observed {
        /// The share of the surface on which stripes cross by 30 degrees or more, 0..1.
        pub crossing: f64,
        /// The direction of most stripes, in the world: a unit vector, either way round.
        pub stripes_along: [f64; 3],
        /// Of the six motions of a rigid piece against the surface, so many are held; 3 on a plane.
        pub held_directions: u32,
    }
}

layout! {
    /// What the tracker's readings are like, by themselves and by the surface.
    #[derive(Copy)]
    pub struct TrackerFit {
        /// White noise of a reading, along one axis.
        pub white_position_m: f64,
        /// White noise of a reading, about one axis.
        pub white_rotation_rad: f64,
        /// How large the fast correction is beside what white noise allows; above 0.55 the noise is not white. `None` when the
        /// scan holds too little to tell, and in live revisions.
        pub excess: Option<f64>,
        /// The variance that a reading was given, in units of its white noise: above 1 it was believed less.
        pub inflation: f64,
    }
}

layout! {
    /// What one revision rests on. Sigmas are one standard deviation.
    pub struct Refinement {
        /// The revision is that of the trajectory.
        pub header: Header,
        /// How far points lie from their common surface with the smoothed tracker alone (1.4826 times the median).
        pub residual_before_m: f64,
        /// The same on the refined way.
        pub residual_after_m: f64,
        /// The rig's pose offset is so much too large.
        pub pose_offset_error_nanos: i64,
        /// How well that is known; 0 when nobody has asked yet (live revisions).
        pub pose_offset_sigma_nanos: i64,
        /// Orientations are so much older than the tracker says, apart from that offset; 0 where nobody asked.
        pub rotation_lag_error_nanos: i64,
        /// How well that is known; 0 where nobody asked.
        pub rotation_lag_sigma_nanos: i64,
        /// What the tracker's readings are like.
        pub tracker: TrackerFit,
        /// False when the hand-eye transform was held fast.
        pub hand_eye_freed: bool,
        /// Its correction along the axes of the body; zeros when it was held fast.
        pub hand_eye_shift_m: [f64; 3],
        /// The same about the axes of the body.
        pub hand_eye_turn_rad: [f64; 3],
        /// How well the shift is known, where shift and turn have traded.
        pub hand_eye_shift_sigma_m: [f64; 3],
        /// How well the turn is known.
        pub hand_eye_turn_sigma_rad: [f64; 3],
        /// What the scan determines; `None` when nobody has asked yet (live revisions, until enough was seen).
        pub observed: Option<Observed>,
        /// What the operator should know, in sentences.
        pub notices: Vec<String>,
        /// The frames that were kept, in the order of their stamps.
        pub frames: Bulk<FrameFit>,
        /// Left out because their points stand off the surface that all others agree on.
        pub misfits: Bulk<FrameFit>,
        /// Left out because nothing else saw what they saw, so nothing says where they were.
        pub unheld: Bulk<FrameFit>,
    }
}
message!(Refinement @ 3);

impl Refinement {
    /// All frames that were left out, for either reason.
    pub fn left_out(&self) -> impl Iterator<Item = &FrameFit> {
        self.misfits.iter().chain(self.unheld.iter())
    }
}
