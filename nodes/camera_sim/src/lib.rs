//! Pictures of a world that is known exactly.
//!
//! In: a [`world::Known`] scene, handset, hand and seed. Out: [`wire::Frame`]s, as the handset's camera takes them on the
//! hand's way; and, for tests and reports alone, where the camera truly was and where the laser's line truly is.
//!
//! Frame `k` is exposed around (k + 1/2) / rate, on the scan's clock, which is also where its stamp stands. What lights it
//! is the operator's phase: the laser for `shape` (and while aiming), the lamp for `colour`; in `both` every n-th frame
//! has the lamp and all others the laser, so one sweep gives both. How a picture is made: [`world::optics`].
//!
//! Every frame is a pure function of its index, so a batch is rendered on all cores and comes out the same on any number
//! of them.
//!
//! ```
//! use camera_sim::CameraSim;
//! # let text = r#"
//! # camera = { width = 160, height = 120, fx = 250.0, fy = 250.0, cx = 79.5, cy = 59.5 }
//! # laser = { normal = [-0.894, 0.0, 0.447], distance_m = 0.0894, channel_weights = [1, 0, 0], peaks_per = "row" }
//! # body_from_camera = { translation_m = [0, 0, 0], rotation_wxyz = [1, 0, 0, 0] }"#;
//! let (scene, rig) = (world::Scene::cow().unwrap(), geometry::Rig::parse(text).unwrap());
//! let hand = world::Hand::new(&scene, &rig, 2.0, 1).unwrap();
//! let camera = CameraSim::new(&world::Known { scene, rig, hand, seed: 1 }).unwrap();
//! assert_eq!(camera.frames(), 50);
//! let frame = camera.frame(7);
//! assert_eq!(frame.header.stamp_nanos, 300_000_000);
//! assert_eq!(frame.data.len(), 160 * 120 * 3);
//! ```

mod camera;
#[cfg(feature = "node")]
pub mod node;

pub use camera::{CameraSim, CameraSimError};
/// What the node is told: the same for both simulated nodes.
pub use world::Setup as Config;
