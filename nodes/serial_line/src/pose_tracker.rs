//! What turns the records of a device into poses.

use wire::Pose;

/// A pose of one sensor. Its stamp is on the clock of the arrivals.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorPose {
    /// Which of the configured sensors, from 0.
    pub sensor: usize,
    /// The pose; scan, phase and sequence number are for the node to fill in.
    pub pose: Pose,
    /// How much the arrival was moved: jitter, wire and latency, in nanoseconds.
    pub removed_nanos: i64,
}

/// Turns records into poses.
pub trait PoseTracker {
    /// What its device sends.
    type Record: Send + 'static;
    /// What to call the record of a sensor that was not asked for.
    const STRANGER: &'static str;
    /// The pose in a record that came whole at a moment, `missed` others in pieces before it; `None` for the record of a
    /// sensor that was not asked for.
    fn process(&mut self, record: &Self::Record, arrival_nanos: i64, missed: u32) -> Option<SensorPose>;
    /// The jitter that was taken from a sensor's arrivals in the last seconds: root mean square and the most.
    fn jitter_nanos(&self, sensor: usize) -> Option<(f64, f64)>;
}
