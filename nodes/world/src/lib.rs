//! The known world of the simulator: scene, light, hand and tracker as pure functions of (scene, rig, seed, time).
//!
//! Both simulated nodes link this crate and never talk to each other: what they show fits together because they compute
//! the same world. Either one can be swapped for the real thing alone.
//!
//! In: a scene file (config/scenes), a rig file with what only a simulator knows of it (`[simulation]`), seconds, a seed.
//! Out, for any moment and in any order:
//!
//! - [`Scene`]: surfaces with their colours, the truth. A toy cow and plain things are modelled in the code as signed
//!   distances and made into closed meshes; other things come from files.
//! - [`Hand`]: where the handset truly is (`world_from_body`, `world_from_camera`), and what the operator is doing. It
//!   strokes to and fro while it goes around the thing and over its top, some 20 cm away, with sway and tremor.
//! - [`Tracker`]: what an honest tracker says of that, each of its errors a number in the rig file.
//! - [`optics`]: what the camera sees.
//!
//! Frames: `world` has z up, the table's top is z = 0 and its middle the origin; `body` and `camera` are the rig's. Metres,
//! radians, seconds from the start of the sweep. Same inputs, same bytes, on any number of threads.
//!
//! Limits: nothing bends or moves but the handset; the hand follows the ellipsoid in the thing's bounds, so that a thing
//! with a deep hollow is seen from outside only, and it does not know whether it would strike a tall neighbour.
//!
//! ```
//! use world::{Hand, Scene, Tracker};
//! let scene = Scene::parse("[[object]]\nkind = \"mug\"\nsides_mm = [112, 80, 92]\n[table]", "".as_ref())?;
//! let rig = geometry::Rig::parse(r#"
//!     camera = { width = 768, height = 576, fx = 1200, fy = 1200, cx = 384, cy = 288 }
//!     laser = { normal = [-0.894, 0, 0.447], distance_m = 0.0894, channel_weights = [1, 0, 0], peaks_per = "row" }
//!     body_from_camera = { translation_m = [0.05, 0, 0], rotation_wxyz = [1, 0, 0, 0] }
//! "#)?;
//! let (seconds, seed) = (30.0, 7);
//! let hand = Hand::new(&scene, &rig, seconds, seed)?;
//! let truth = hand.world_from_camera(12.0);
//! assert!(truth.translation.vector.z > 0.02, "it keeps off the table");
//! let tracker = Tracker::new(&rig, hand, seed)?;
//! let said = tracker.sample(1200);
//! assert_eq!(said, tracker.sample(1200));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod hand;
pub mod optics;
mod random;
mod scene;
mod setup;
mod shape;
mod simulation;
mod tracker;

pub use hand::{Hand, HandError, HandSection};
pub use scene::{ALL, Kind, ObjectSection, Scene, SceneError, SceneFile, Surface, TableSection, Texture, Up};
pub use setup::{Known, Setup, SetupError};
pub use shape::{Pattern, Primitive};
pub use simulation::{HandEyeError, Simulation, SimulationError};
pub use tracker::{Tracker, TrackerSection};
