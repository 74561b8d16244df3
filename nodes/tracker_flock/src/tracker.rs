//! Records to poses, each with its stamp and what is known of its error.

use crate::config::{Config, ConfigError};
use crate::hemisphere::HalfSpace;
use crate::protocol::reading::{NoReading, QuaternionSense, Reading};
use crate::protocol::records::{Layout, Record};
use nalgebra::Vector3;
use serial_line::{RateLock, Undelayed, wire_nanos};
use wire::{Clock, Header, Pose, Quality, RigidPose};

/// A record as the port heard it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Heard {
    /// The words.
    pub record: Record,
    /// How it lay on the wire.
    pub layout: Layout,
    /// Which way its quaternion turns, when it has one.
    pub sense: QuaternionSense,
}

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
#[derive(Debug, Clone)]
pub struct FlockTracker {
    config: Config,
    birds: Vec<Bird>,
    cycle: u64,
    last_address: Option<u8>,
    strangers: u64,
}

#[derive(Debug, Clone)]
struct Bird {
    address: u8,
    lock: RateLock,
    half: HalfSpace,
    last_cycle: u64,
}

impl FlockTracker {
    /// A tracker for the sensors of a configuration.
    pub fn new(config: Config) -> Result<Self, ConfigError> {
        config.check()?;
        let period = 1e9 / config.rate_hz * f64::from(config.report_every);
        let bird = |&address: &u8| Bird {
            address,
            lock: RateLock::new(Some(period)),
            half: HalfSpace::default(),
            last_cycle: 0,
        };
        let birds = config.addresses().iter().map(bird).collect();
        Ok(Self { birds, config, cycle: 0, last_address: None, strangers: 0 })
    }

    /// The pose in a record that came whole at a moment, `missed` others in pieces before it; `None` for the record of a
    /// unit that was not asked for, which is counted.
    pub fn process(&mut self, heard: &Heard, arrival_nanos: i64, missed: u32) -> Option<SensorPose> {
        let Heard { record, layout, sense } = heard;
        self.count_cycle(record.address, missed);
        let address = if layout.group { record.address } else { self.birds.first()?.address };
        let Some(sensor) = self.birds.iter().position(|bird| bird.address == address) else {
            self.strangers += 1;
            return None;
        };
        let bird = &mut self.birds[sensor];
        let skipped = self.cycle.saturating_sub(bird.last_cycle + 1);
        bird.last_cycle = self.cycle;
        let undelayed = bird.lock.undelay(arrival_nanos, u32::try_from(skipped).unwrap_or(u32::MAX));
        let (position_latency, rotation_latency) = self.config.latencies_nanos();
        // The units' records follow one another on the line: this one's own, and those of the lower addresses.
        let wire = wire_nanos(layout.bytes() * (sensor + 1), self.config.baud);
        let stamp_nanos = undelayed.nanos - wire - position_latency;
        let reading = Reading::of(record, self.config.scale_inches, *sense);
        let mut pose = match reading {
            Ok(reading) => measured(&self.config, bird, reading, stamp_nanos),
            Err(reason) => lost(reason),
        };
        pose.header = Header { stamp_nanos, clock: Clock::System, ..Header::default() };
        pose.rotation_lag_nanos = rotation_latency - position_latency;
        judge(&self.config, &mut pose, record, undelayed);
        Some(SensorPose { sensor, pose, removed_nanos: arrival_nanos - stamp_nanos })
    }

    /// The jitter that was taken from a sensor's arrivals in the last seconds: root mean square and the most.
    pub fn jitter_nanos(&self, sensor: usize) -> Option<(f64, f64)> {
        self.birds.get(sensor).map(|bird| bird.lock.jitter_nanos())
    }

    /// Records so far of units that were not asked for.
    pub fn strangers(&self) -> u64 {
        self.strangers
    }

    /// In group mode a cycle begins where the addresses begin anew.
    fn count_cycle(&mut self, address: u8, missed: u32) {
        let rounds = u64::from(missed) / self.birds.len() as u64;
        self.cycle += rounds;
        if self.last_address.is_none_or(|last| address <= last) {
            self.cycle += 1;
        }
        self.last_address = Some(address);
    }
}

fn lost(reason: NoReading) -> Pose {
    Pose {
        header: Header::default(),
        world_from_body: RigidPose::IDENTITY,
        position_sigma_m: [0.0; 3],
        rotation_sigma_rad: [0.0; 3],
        rotation_lag_nanos: 0,
        quality: Quality::Lost,
        reason: reason.to_string(),
    }
}

fn measured(config: &Config, bird: &mut Bird, reading: Reading, stamp_nanos: i64) -> Pose {
    let reported = reading.position_m.unwrap_or_default();
    let position = if config.follow_hemisphere { bird.half.follow(stamp_nanos, reported).0 } else { reported };
    let rotation = reading.rotation.unwrap_or_default();
    let growth = far_away(config, &position);
    Pose {
        header: Header::default(),
        world_from_body: RigidPose {
            translation_m: position.into(),
            rotation_wxyz: [rotation.w, rotation.i, rotation.j, rotation.k],
        },
        position_sigma_m: [config.position_sigma_mm * 1e-3 * growth; 3],
        rotation_sigma_rad: [config.rotation_sigma_deg.to_radians() * growth; 3],
        rotation_lag_nanos: 0,
        quality: Quality::Good,
        reason: String::new(),
    }
}

/// How much larger the noise is than the data sheet has it: a dipole's field falls with r^3, so a change of r shows in it
/// with r^-4.
fn far_away(config: &Config, position_m: &Vector3<f64>) -> f64 {
    (position_m.norm() / config.good_to_m).max(1.0).powi(4)
}

/// Says why a pose is not as good as it could be.
fn judge(config: &Config, pose: &mut Pose, record: &Record, undelayed: Undelayed) {
    if pose.quality == Quality::Lost {
        return;
    }
    let mut reasons = Vec::new();
    let distance = Vector3::from(pose.world_from_body.translation_m).norm();
    if distance > config.good_to_m {
        reasons
            .push(format!("{distance:.2} m from the transmitter; the data sheet holds to {:.2} m", config.good_to_m));
    }
    if record.metal >= config.most_metal {
        let growth = f64::from(record.metal) / f64::from(config.most_metal);
        pose.position_sigma_m = pose.position_sigma_m.map(|sigma| sigma * growth);
        pose.rotation_sigma_rad = pose.rotation_sigma_rad.map(|sigma| sigma * growth);
        reasons.push(format!("metal near (measure {} of 127)", record.metal));
    }
    if !undelayed.settled {
        reasons.push("the clock is not settled yet".to_owned());
    }
    if !reasons.is_empty() {
        pose.quality = Quality::Degraded;
        pose.reason = reasons.join("; ");
    }
}
