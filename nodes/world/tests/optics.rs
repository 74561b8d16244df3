//! Pictures against what light and lens must give.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

#[path = "optics/bench.rs"]
mod bench;
#[path = "optics/laser.rs"]
mod laser;
#[path = "optics/light.rs"]
mod light;
#[path = "optics/refused.rs"]
mod refused;
#[path = "optics/sensor.rs"]
mod sensor;
