//! The known world of the simulator: scene, light, hand and tracker as pure functions of (scene, rig, seed, time).
//!
//! Both simulated nodes link this crate and never talk to each other: what they show fits together because they compute
//! the same world.

mod hand;
pub mod optics;
mod scene;
mod simulation;
mod tracker;

pub use hand::HandSection;
pub use scene::{Scene, SceneError, Surface, Texture};
pub use simulation::{Simulation, SimulationError};
pub use tracker::TrackerSection;
