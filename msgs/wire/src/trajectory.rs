//! The way of the camera.

use crate::layout::{element, layout, message};
use crate::{Bulk, Header};

element! {
    /// Where the camera was at one moment: world_from_camera.
    pub struct TrajectorySample {
        /// The moment, on the camera's clock.
        pub stamp_nanos: i64,
        /// In the world.
        pub translation_m: [f64; 3],
        /// Unit quaternion w, x, y, z.
        pub rotation_wxyz: [f64; 4],
        /// One standard deviation of the position.
        pub position_sigma_m: f64,
        /// One standard deviation of the orientation.
        pub rotation_sigma_rad: f64,
    }
}

layout! {
    /// The samples since the message before; all of them together are the trajectory of this revision.
    pub struct Trajectory {
        /// The stamp is the last sample's.
        pub header: Header,
        /// In the order of their stamps.
        pub samples: Bulk<TrajectorySample>,
    }
}
message!(Trajectory @ 1);
