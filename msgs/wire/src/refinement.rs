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
        /// Correction of the hand-eye transform along the axes of the body; zeros when it was held fast.
        pub hand_eye_shift_m: [f64; 3],
        /// The same about the axes of the body.
        pub hand_eye_turn_rad: [f64; 3],
        /// How well the shift is known, where shift and turn have traded.
        pub hand_eye_shift_sigma_m: [f64; 3],
        /// How well the turn is known.
        pub hand_eye_turn_sigma_rad: [f64; 3],
        /// What the scan determines; `None` when nobody has asked yet (live revisions).
        pub observed: Option<Observed>,
        /// What the operator should know, in sentences.
        pub notices: Vec<String>,
        /// The frames that were kept, in the order of their stamps.
        pub frames: Bulk<FrameFit>,
        /// Those that were left out, because they fit nowhere or nothing held them.
        pub left_out: Bulk<FrameFit>,
    }
}
message!(Refinement @ 2);
