//! Light, lens and sensor: a camera picture made from physics.
//!
//! A picture is made in four steps, each a file. *See*: the scene's meshes through the real lens
//! ([`geometry::VisibilityBuffer`]). *Light*: the room and the lamp on each visible triangle (`shade`); the laser's fan
//! is cut with the mesh, shadowed, and each lit piece throws its light onto the picture (`fan`, `line`). *Blur*: the
//! lens's Gaussian, integrated over the pixels, over all of it (`psf`, `blur`). *Expose*: vignette, speckle, gain, shot
//! and read noise, gamma, eight bits (`sensor`).
//!
//! Light is linear and in units of the sensor's full scale at gain 1. Every random number is hashed from (seed, frame,
//! pixel), so a picture is the same on any number of threads and in any order.
//!
//! Left out, and known to be: motion blur (the picture is that of the middle of the exposure), light from surface to
//! surface, the lamp's shadows (it sits beside the lens: paper, section 2.5), defocus with distance, the laser's
//! spreading out of its focus, and a mosaic of colours on the sensor.

mod blur;
mod error;
mod fan;
mod gain;
mod line;
mod psf;
mod random_field;
mod render;
mod section;
mod sensor;
mod shade;
mod stage;
mod tessellate;
mod texture;

pub use error::OpticsError;
pub use render::{CameraModelSim, Workspace};
pub use section::{GainSection, LampSection, LaserLightSection, OpticsSection, SensorSection};
