//! The surface (paper, section 2.4: the zero set).

use crate::layout::{layout, message};
use crate::{Bulk, Header};

layout! {
    /// The whole surface as triangles, counter-clockwise seen from outside.
    pub struct Mesh {
        /// The stamp is the latest scan's that went in; phase `End` marks the final one.
        pub header: Header,
        /// In the world, in metres.
        pub vertices_m: Bulk<[f32; 3]>,
        /// One unit normal for each vertex, or none.
        pub normals: Bulk<[f32; 3]>,
        /// One standard deviation of each vertex along its normal, or none.
        pub sigma_m: Bulk<f32>,
        /// Three vertices each.
        pub triangles: Bulk<[u32; 3]>,
    }
}
message!(Mesh @ 1);
