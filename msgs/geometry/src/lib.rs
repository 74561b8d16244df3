//! Space, as several nodes need it: the camera, the laser sheet, poses and trajectories, meshes and distances to them.
//!
//! Frames: `world` (the tracker's base), `body` (its receiver on the handset), `camera` (x right, y down, z forward). A
//! transform is named for what it does: `world_from_camera * p_in_camera = p_in_world`. Pixels: u right, v down, (0, 0)
//! is the centre of the top-left pixel. Metres, radians and nanoseconds throughout; f64 for poses and calibration, f32
//! for bulk points.
//!
//! ```
//! use geometry::{Camera, LaserSheet};
//! use nalgebra::{Point2, Vector3};
//! let camera = Camera { width: 640, height: 480, fx: 800.0, fy: 800.0, cx: 319.5, cy: 239.5, distortion: [0.0; 5] };
//! let sheet = LaserSheet::new(Vector3::new(0.0, 0.0, 1.0), 0.2).unwrap();
//! let p_in_camera = sheet.intersect(&camera.direction(Point2::new(319.5, 239.5))).unwrap();
//! assert!((p_in_camera.z - 0.2).abs() < 1e-12);
//! ```

mod align;
mod camera;
mod distance;
mod index;
mod mesh;
mod pose;
mod random;
mod raster;
mod rig;
mod sample;
mod sheet;
pub mod smooth;
mod table;
mod trajectory;

pub use align::{AlignError, Alignment, align};
pub use camera::{Camera, CameraError};
pub use distance::{
    COMPARE_SAMPLES, CompareError, Comparison, Completeness, Distances, WITHIN_MM, Within, compare, distances_to,
    truth_samples,
};
pub use index::{Closest, Hit, MeshIndex};
pub use mesh::{MeshError, TriangleMesh};
pub use pose::{interpolate, rigid_from_wire, rigid_to_wire};
pub use random::{sign, uniform, word};
pub use raster::{LONGEST_EDGE_PX, NO_TRIANGLE, VisibilityBuffer};
pub use rig::{ClockSection, LaserSection, Rig, RigError, TransformSection};
pub use sample::{SurfaceSample, sample_surface};
pub use sheet::{LaserSheet, SheetError};
pub use smooth::{FixedLagSmoother, Silence, SmoothCounts, SmoothError, SmoothTrajectory, Smoothing, Wait};
pub use table::{Facing, Table, TableSearch};
pub use trajectory::{NoPose, TimedPose, TrajectoryBuffer};

/// Metres from millimetres.
pub const METRES_PER_MM: f64 = 1e-3;
