//! The lit points of one picture in space (paper, section 2.2: x).

use crate::layout::{element, layout, message};
use crate::{Bulk, Header, Refusal};

element! {
    /// One point where a camera ray meets the laser sheet.
    pub struct ProfilePoint {
        /// In the frame of the camera.
        pub position_m: [f32; 3],
        /// One standard deviation along the camera ray.
        pub range_sigma_m: f32,
        /// One standard deviation across the ray, in the direction in which the stripe was measured.
        pub lateral_sigma_m: f32,
        /// Height of the peak above the background, in grey levels.
        pub amplitude: f32,
        /// The row or column that it was measured in: neighbours on the stripe have neighbouring numbers.
        pub line: u32,
    }
}

layout! {
    /// All points of one picture, in the order of the stripe.
    pub struct Profile {
        /// The stamp is the frame's.
        pub header: Header,
        /// The points.
        pub points: Bulk<ProfilePoint>,
        /// Peaks that gave no point.
        pub refused: Vec<Refusal>,
    }
}
message!(Profile @ 1);
