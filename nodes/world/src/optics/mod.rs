//! Light, lens and sensor.

mod section;

pub use section::OpticsSection;
