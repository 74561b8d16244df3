//! The points of one picture in the world (paper, section 2.3: R x + p).

use crate::layout::{element, layout, message};
use crate::{Bulk, Extent, Header, Refusal, RigidPose};

element! {
    /// One measured point.
    pub struct ScanPoint {
        /// In the world.
        pub position_m: [f32; 3],
        /// Unit vector from the point to the camera.
        pub to_sensor: [f32; 3],
        /// One standard deviation of the position along `to_sensor`; of the pose's error it has what differs from picture to
        /// picture, where that is known (`refine`).
        pub sigma_m: f32,
        /// Height of the peak above the background, in grey levels.
        pub amplitude: f32,
    }
}

layout! {
    /// All points of one picture, in the world.
    pub struct Scan {
        /// The stamp is the frame's.
        pub header: Header,
        /// What becomes of what came under lower revisions. [`Extent::Whole`]: it is void. [`Extent::Changes`]: it stands, but
        /// for the picture of this stamp, of which these are now the points.
        pub extent: Extent,
        /// Where the camera was.
        pub world_from_camera: RigidPose,
        /// One standard deviation of the camera's position, as the tracker states it.
        pub position_sigma_m: f64,
        /// One standard deviation of its orientation.
        pub rotation_sigma_rad: f64,
        /// One standard deviation of how far the regions seen here may stand off as wholes, along their normals (root mean
        /// square over them): however many pictures saw them, it does not average out. 0 where nobody knows.
        pub region_sigma_m: f64,
        /// The points.
        pub points: Bulk<ScanPoint>,
        /// Profiles and points that had no pose, by reason.
        pub refused: Vec<Refusal>,
    }
}
message!(Scan @ 3);

impl Scan {
    /// No points: of a picture without a pose, and behind the last one.
    pub fn none(header: Header) -> Self {
        Self {
            header,
            extent: Extent::Whole,
            world_from_camera: RigidPose::IDENTITY,
            position_sigma_m: 0.0,
            rotation_sigma_rad: 0.0,
            region_sigma_m: 0.0,
            points: Bulk::default(),
            refused: Vec::new(),
        }
    }
}
