//! Records to poses, each with its stamp and what is known of its error.

use crate::config::{Config, DataSheet};
use crate::protocol::errors::{is_well, sentence};
use crate::protocol::records::{Layout, Record};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serial_line::{
    ConfigError, DeviceClock, HELD_UP, HalfSpace, PoseTracker, RateLock, Rounds, SensorPose, Turn, Undelayed,
    wire_nanos,
};
use wire::{Clock, Header, Pose, Quality, RigidPose};

const INCH_M: f64 = 0.0254;
/// The device's clock ticks in milliseconds.
const TICK_NANOS: f64 = 1e6;

/// Turns records into poses.
#[derive(Debug, Clone)]
pub struct PolhemusTracker {
    config: Config,
    sheet: DataSheet,
    record_bytes: usize,
    rounds: Rounds,
    clocks: Vec<StationClock>,
    halves: Vec<HalfSpace>,
}

#[derive(Debug, Clone)]
enum StationClock {
    /// Even steps, found from the arrivals.
    Rate(RateLock),
    /// The device's own.
    Device(DeviceClock),
}

impl PolhemusTracker {
    /// A tracker for the stations of a configuration.
    pub fn new(config: Config) -> Result<Self, ConfigError> {
        config.check()?;
        let sheet = config.sheet();
        let clock = |_: &u8| match config.family.has_clock() {
            true => StationClock::Device(DeviceClock::new(TICK_NANOS, Some(1e9 / sheet.rate_hz))),
            false => StationClock::Rate(RateLock::new(Some(1e9 / sheet.rate_hz))),
        };
        let clocks = config.stations.iter().map(clock).collect();
        let halves = vec![HalfSpace::default(); config.stations.len()];
        let (rounds, record_bytes) = (Rounds::new(&config.stations), Layout::of(config.family).bytes());
        Ok(Self { rounds, clocks, halves, record_bytes, sheet, config })
    }
}

impl PoseTracker for PolhemusTracker {
    type Record = Record;
    const STRANGER: &'static str = "record of a station that is not in `stations`";

    fn process(&mut self, record: &Record, arrival_nanos: i64, missed: u32) -> Option<SensorPose> {
        let Turn { sensor, skipped } = self.rounds.place(record.station, missed)?;
        let undelayed = match &mut self.clocks[sensor] {
            StationClock::Rate(lock) => Some(lock.undelay(arrival_nanos, skipped)),
            StationClock::Device(clock) => clock.undelay(record.time_stamp_ms, arrival_nanos),
        };
        // The stations' records follow one another on the line.
        let wire = wire_nanos(self.record_bytes * (sensor + 1), self.config.baud);
        let old = (self.sheet.latency_ms * 1e6) as i64;
        let stamp_nanos = undelayed.map_or(arrival_nanos, |undelayed| undelayed.nanos) - wire - old;
        let mut pose = measured(record);
        if self.config.follow_hemisphere {
            let reported = pose.world_from_body.translation_m;
            pose.world_from_body.translation_m = self.halves[sensor].follow(stamp_nanos, reported);
        }
        pose.header = Header { stamp_nanos, clock: Clock::System, ..Header::default() };
        self.judge(&mut pose, record, undelayed);
        Some(SensorPose { sensor, pose, removed_nanos: arrival_nanos - stamp_nanos })
    }

    fn jitter_nanos(&self, sensor: usize) -> Option<(f64, f64)> {
        self.clocks.get(sensor).map(|clock| match clock {
            StationClock::Rate(lock) => lock.jitter_nanos(),
            StationClock::Device(clock) => clock.jitter_nanos(),
        })
    }
}

impl PolhemusTracker {
    /// Sigma by distance and distortion, and why a pose is not as good as it could be.
    fn judge(&self, pose: &mut Pose, record: &Record, undelayed: Option<Undelayed>) {
        let mut reasons = Vec::new();
        let distance = Vector3::from(pose.world_from_body.translation_m).norm();
        // A dipole's field falls with r^3, so a change of r shows in it with r^-4.
        let mut growth = (distance / self.sheet.good_to_m).max(1.0).powi(4);
        if distance > self.sheet.good_to_m {
            let good_to = self.sheet.good_to_m;
            reasons.push(format!("{distance:.2} m from the source; the data sheet holds to {good_to:.2} m"));
        }
        let distortion = record.distortion.saturating_abs();
        if distortion >= self.config.most_distortion {
            growth *= f64::from(distortion) / f64::from(self.config.most_distortion);
            reasons.push(format!("the field is bent (level {distortion}): metal is near"));
        }
        if !is_well(self.config.family, record.error) {
            // As ASCII has it: `u`, `\x08`.
            let letter = record.error.escape_ascii();
            let why = sentence(self.config.family, record.error).unwrap_or("see the errors in its manual");
            reasons.push(format!("station {} reports `{letter}`: {why}", record.station));
        }
        if undelayed.is_some_and(|undelayed| !undelayed.settled) {
            reasons.push("the clock is not settled yet".to_owned());
        }
        pose.position_sigma_m = [self.sheet.position_sigma_mm * 1e-3 * growth; 3];
        pose.rotation_sigma_rad = [self.sheet.rotation_sigma_deg.to_radians() * growth; 3];
        if undelayed.is_none() {
            pose.quality = Quality::Lost;
            reasons.push(format!("its time stamp, {} ms, does not follow", record.time_stamp_ms));
        } else if undelayed.is_some_and(|undelayed| undelayed.held_up) {
            pose.quality = Quality::Lost;
            reasons.push(HELD_UP.to_owned());
        } else if !reasons.is_empty() {
            pose.quality = Quality::Degraded;
        }
        pose.reason = reasons.join("; ");
    }
}

fn measured(record: &Record) -> Pose {
    let [w, x, y, z] = record.quaternion_wxyz.map(f64::from);
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    Pose {
        header: Header::default(),
        world_from_body: RigidPose {
            translation_m: record.position_inches.map(|inches| f64::from(inches) * INCH_M),
            rotation_wxyz: [rotation.w, rotation.i, rotation.j, rotation.k],
        },
        position_sigma_m: [0.0; 3],
        rotation_sigma_rad: [0.0; 3],
        rotation_lag_nanos: 0,
        quality: Quality::Good,
        reason: String::new(),
    }
}
