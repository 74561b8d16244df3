//! The numbers that all the rest stands on (paper, section 2.2: c, v, l, m, and the handset's own transform).

use crate::layout::{layout, message};
use crate::{Header, RigidPose};

layout! {
    /// Pinhole camera with Brown-Conrady distortion (k1, k2, p1, p2, k3).
    #[derive(Copy)]
    pub struct CameraIntrinsics {
        /// Pixels in a row.
        pub width: u32,
        /// Rows.
        pub height: u32,
        /// Focal length in pixels, along u.
        pub fx: f64,
        /// Focal length in pixels, along v.
        pub fy: f64,
        /// Principal point, u.
        pub cx: f64,
        /// Principal point, v.
        pub cy: f64,
        /// k1, k2, p1, p2, k3.
        pub distortion: [f64; 5],
    }
}

layout! {
    /// Along which lines of the picture the stripe has one peak.
    pub enum PeaksPer {
        /// One peak a row: the stripe runs from top to bottom.
        Row,
        /// One peak a column: the stripe runs from left to right.
        Column,
    }
}

layout! {
    /// The laser sheet: normal . p_in_camera = distance_m.
    #[derive(Copy)]
    pub struct LaserPlane {
        /// Unit normal, in the frame of the camera.
        pub normal: [f64; 3],
        /// Along the normal.
        pub distance_m: f64,
        /// How much of red, green and blue is summed into the laser's grey level.
        pub channel_weights: [f64; 3],
        /// Which way the stripe runs.
        pub peaks_per: PeaksPer,
    }
}

layout! {
    /// A calibrated handset; latched.
    pub struct Calibration {
        /// Counts the calibrations.
        pub header: Header,
        /// The camera.
        pub camera: CameraIntrinsics,
        /// The laser.
        pub laser: LaserPlane,
        /// The camera on the handset.
        pub body_from_camera: RigidPose,
        /// Added to a pose's stamp, it gives the camera's clock.
        pub pose_offset_nanos: i64,
        /// What the rig file calls this handset.
        pub name: String,
    }
}
message!(Calibration @ 1);
