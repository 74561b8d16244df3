//! The thinned cloud (paper, section 2.4: the ball clustering).

use crate::layout::{element, layout, message};
use crate::{Bulk, Header, Refusal};

element! {
    /// The average of the points in one ball.
    pub struct CloudPoint {
        /// Mean position, in the world.
        pub position_m: [f32; 3],
        /// Unit normal, on the side from which it was seen.
        pub normal: [f32; 3],
        /// Root mean square distance of the points from their tangent plane.
        pub spread_m: f32,
        /// One standard deviation of the mean along the normal.
        pub sigma_m: f32,
        /// How many points were averaged. 0 among changes: the ball is no longer part of the cloud.
        pub count: u32,
        /// The number of the ball: it stays the same while the ball grows.
        pub id: u32,
        /// Mean colour, red, green, blue; the fourth byte is 255 when there is one.
        pub colour: [u8; 4],
    }
}

layout! {
    /// Whether a message holds everything or what changed.
    pub enum Extent {
        /// What changed since the message before.
        Changes,
        /// All there is; whoever holds an older state drops it.
        Whole,
    }
}

layout! {
    /// The table on which a thing stands: normal . p = distance_m, in the world, the normal upwards.
    #[derive(Copy)]
    pub struct TablePlane {
        /// Unit normal, towards the thing.
        pub normal: [f64; 3],
        /// Along the normal.
        pub distance_m: f64,
    }
}

layout! {
    /// The cloud, or what of it changed.
    pub struct Cloud {
        /// The stamp is the latest scan's that went in.
        pub header: Header,
        /// Whether this is all of it.
        pub extent: Extent,
        /// What was taken away as the table; nothing of the thing is below it.
        pub table: Option<TablePlane>,
        /// The balls, by their numbers.
        pub points: Bulk<CloudPoint>,
        /// Points that went into no ball of this cloud, by reason.
        pub refused: Vec<Refusal>,
    }
}
message!(Cloud @ 3);
