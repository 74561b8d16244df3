//! Records to poses, each with its stamp and what is known of its error.

use crate::config::Config;
use crate::protocol::reading::{NoReading, QuaternionSense, Reading};
use crate::protocol::records::{Layout, Record};
use nalgebra::Vector3;
use serial_line::{
    ConfigError, HELD_UP, HalfSpace, PoseTracker, RateLock, Rounds, SensorPose, Turn, Undelayed, wire_nanos,
};
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

/// Turns records into poses.
#[derive(Debug, Clone)]
pub struct FlockTracker {
    config: Config,
    rounds: Rounds,
    birds: Vec<Bird>,
}

#[derive(Debug, Clone)]
struct Bird {
    lock: RateLock,
    half: HalfSpace,
}

impl FlockTracker {
    /// A tracker for the sensors of a configuration.
    pub fn new(config: Config) -> Result<Self, ConfigError> {
        config.check()?;
        let period = 1e9 / config.rate_hz * f64::from(config.report_every);
        let addresses = config.addresses();
        let bird = |_: &u8| Bird { lock: RateLock::new(Some(period)), half: HalfSpace::default() };
        Ok(Self { birds: addresses.iter().map(bird).collect(), rounds: Rounds::new(&addresses), config })
    }
}

impl PoseTracker for FlockTracker {
    type Record = Heard;
    const STRANGER: &'static str = "record of a unit that is not in `sensors`";

    /// A bird alone sends no address: its records have 0, which is its own.
    fn process(&mut self, heard: &Heard, arrival_nanos: i64, missed: u32) -> Option<SensorPose> {
        let Heard { record, layout, sense } = heard;
        let Turn { sensor, skipped } = self.rounds.place(record.address, missed)?;
        let bird = &mut self.birds[sensor];
        let undelayed = bird.lock.undelay(arrival_nanos, skipped);
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

    fn jitter_nanos(&self, sensor: usize) -> Option<(f64, f64)> {
        self.birds.get(sensor).map(|bird| bird.lock.jitter_nanos())
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
    let followed = |half: &mut HalfSpace| half.follow(stamp_nanos, reported.into()).into();
    let position = if config.follow_hemisphere { followed(&mut bird.half) } else { reported };
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
    if undelayed.held_up {
        reasons.push(HELD_UP.to_owned());
    }
    if !reasons.is_empty() {
        pose.quality = if undelayed.held_up { Quality::Lost } else { Quality::Degraded };
        pose.reason = reasons.join("; ");
    }
}
