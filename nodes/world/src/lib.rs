//! The known world of the simulator: scene, light, hand and tracker as pure functions of (scene, rig, seed, time).
//!
//! Both simulated nodes link this crate and never talk to each other: what they show fits together because they compute
//! the same world.

mod hand;
pub mod optics;
mod random;
mod scene;
mod shape;
mod simulation;
mod tracker;

pub use hand::{Hand, HandError, HandSection};
pub use scene::{ALL, Kind, ObjectSection, Scene, SceneError, SceneFile, Surface, TableSection, Texture, Up};
pub use shape::{Pattern, Primitive};
pub use simulation::{Simulation, SimulationError};
pub use tracker::{Tracker, TrackerSection};
