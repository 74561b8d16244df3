//! R(t) x + p(t) (paper, section 2.3).

use crate::readings::Readings;
use crate::{Config, ConfigError};
use geometry::{NoPose, TimedPose, rigid_from_wire, rigid_to_wire};
use nalgebra::{Isometry3, Point3};
use std::collections::{BTreeMap, VecDeque};
use wire::{
    Bulk, Calibration, Header, Pose, Profile, ProfilePoint, Refusal, Scan, ScanPoint, Trajectory, TrajectorySample,
};

/// Why nothing can be registered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RegisterError {
    /// The bounds.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Hand-eye.
    #[error("the calibration's body_from_camera is no rigid transform: {0:?}")]
    HandEye(wire::RigidPose),
}

/// Holds profiles until their poses have come.
#[derive(Debug, Clone)]
pub struct Register {
    config: Config,
    body_from_camera: Isometry3<f64>,
    offset_nanos: i64,
    readings: Readings,
    waiting: VecDeque<Profile>,
    registered: VecDeque<Scan>,
    way: Vec<TrajectorySample>,
    header: Header,
    refused: BTreeMap<&'static str, u64>,
}

const TIMED_OUT: &str = "profile without a pose behind it in time";
const TOO_MANY: &str = "profile, because too many waited for poses";
const BACKWARDS: &str = "profile whose time goes backwards";
const NOT_FINITE: &str = "point that is not finite";

impl Register {
    /// For one calibrated handset.
    pub fn new(config: Config, calibration: &Calibration) -> Result<Self, RegisterError> {
        config.check()?;
        let hand_eye = calibration.body_from_camera;
        Ok(Self {
            config,
            body_from_camera: rigid_from_wire(&hand_eye).ok_or(RegisterError::HandEye(hand_eye))?,
            offset_nanos: calibration.pose_offset_nanos,
            readings: Readings::default(),
            waiting: VecDeque::new(),
            registered: VecDeque::new(),
            way: Vec::new(),
            header: Header::default(),
            refused: BTreeMap::new(),
        })
    }

    /// Takes a reading of the tracker. A higher scan number starts afresh.
    pub fn pose(&mut self, pose: &Pose) {
        self.renew(&pose.header);
        if pose.header.scan < self.header.scan {
            return self.refuse("pose of an older scan", 1);
        }
        match self.readings.take(pose, self.offset_nanos, self.config.use_degraded) {
            Ok(reading) => {
                let camera = TimedPose { pose: reading.pose * self.body_from_camera, ..reading };
                self.way.push((&camera).into());
                self.serve();
            }
            Err(bad) => self.refuse(bad.reason(), 1),
        }
    }

    /// Takes a profile. A higher scan number starts afresh.
    pub fn profile(&mut self, profile: Profile) {
        self.renew(&profile.header);
        if profile.header.scan < self.header.scan {
            return self.refuse("profile of an older scan", 1);
        }
        if self.waiting.back().is_some_and(|last| profile.header.stamp_nanos <= last.header.stamp_nanos) {
            return self.refuse(BACKWARDS, 1);
        }
        self.waiting.push_back(profile);
        self.serve();
        if self.waiting.len() > self.config.most_waiting {
            self.waiting.pop_front();
            self.refuse(TOO_MANY, 1);
        }
    }

    /// The scans that are ready, in the order of their stamps.
    pub fn drain(&mut self) -> impl Iterator<Item = Scan> + '_ {
        self.registered.drain(..)
    }

    /// Where the camera was at the readings since the last call; `None` when there was none.
    pub fn trajectory(&mut self) -> Option<Trajectory> {
        let last = self.way.last()?;
        let header = Header { stamp_nanos: last.stamp_nanos, ..self.header.derived() };
        Some(Trajectory { header, samples: Bulk(std::mem::take(&mut self.way)) })
    }

    /// No reading will come any more: what still waits is refused. Returns what was refused and not yet told.
    pub fn finish(&mut self) -> Vec<Refusal> {
        let left = self.waiting.len() as u64;
        self.waiting.clear();
        if left > 0 {
            self.refuse(unplaced(NoPose::After), left);
        }
        self.take_refused()
    }

    fn renew(&mut self, header: &Header) {
        if header.scan > self.header.scan {
            self.readings.clear();
            self.waiting.clear();
            self.way.clear();
            self.header = Header { stamp_nanos: 0, ..header.derived() };
        }
        self.header.phase = header.phase;
    }

    /// Registers what has its poses by now.
    fn serve(&mut self) {
        while let Some(profile) = self.waiting.front() {
            let stamp_nanos = profile.header.stamp_nanos;
            match self.readings.at(stamp_nanos, self.config.most_gap_nanos()) {
                Ok(body) => {
                    let Some(profile) = self.waiting.pop_front() else { return };
                    let scan = self.register(&profile, &body);
                    self.registered.push_back(scan);
                }
                Err(NoPose::After) => {
                    let newest = self.waiting.back().map_or(stamp_nanos, |last| last.header.stamp_nanos);
                    if newest.saturating_sub(stamp_nanos) <= self.config.most_wait_nanos() {
                        return;
                    }
                    self.waiting.pop_front();
                    self.refuse(TIMED_OUT, 1);
                }
                Err(never) => {
                    self.waiting.pop_front();
                    self.refuse(unplaced(never), 1);
                }
            }
        }
    }

    fn register(&mut self, profile: &Profile, body: &TimedPose) -> Scan {
        let world_from_camera = body.pose * self.body_from_camera;
        let place = Place::new(&world_from_camera);
        let mut points = Vec::with_capacity(profile.points.len());
        points.extend(profile.points.iter().filter_map(|point| place.of(point)));
        self.refuse(NOT_FINITE, (profile.points.len() - points.len()) as u64);
        Scan {
            header: profile.header.derived(),
            world_from_camera: rigid_to_wire(&world_from_camera),
            position_sigma_m: body.position_sigma_m,
            rotation_sigma_rad: body.rotation_sigma_rad,
            points: Bulk(points),
            refused: self.take_refused(),
        }
    }

    fn refuse(&mut self, reason: &'static str, count: u64) {
        if count > 0 {
            *self.refused.entry(reason).or_default() += count;
        }
    }

    fn take_refused(&mut self) -> Vec<Refusal> {
        let refused = std::mem::take(&mut self.refused);
        refused.into_iter().map(|(reason, count)| Refusal { reason: reason.to_owned(), count }).collect()
    }
}

fn unplaced(why: NoPose) -> &'static str {
    match why {
        NoPose::Before => "profile before the first pose",
        NoPose::After => "profile after the last pose",
        NoPose::Gap => "profile in a gap between poses",
    }
}

/// R and p in single precision, relative to the camera's own place so that nothing is lost far from the origin.
struct Place {
    rotation: nalgebra::Matrix3<f32>,
    camera_in_world: Point3<f64>,
}

impl Place {
    fn new(world_from_camera: &Isometry3<f64>) -> Self {
        let rotation = world_from_camera.rotation.to_rotation_matrix().into_inner().cast();
        Self { rotation, camera_in_world: Point3::from(world_from_camera.translation.vector) }
    }

    fn of(&self, point: &ProfilePoint) -> Option<ScanPoint> {
        let ray = self.rotation * nalgebra::Vector3::from(point.position_m);
        let to_sensor = -ray / ray.norm();
        let position = [0, 1, 2].map(|axis| (self.camera_in_world[axis] + f64::from(ray[axis])) as f32);
        let finite =
            position.iter().chain(to_sensor.iter()).chain([&point.range_sigma_m]).all(|value| value.is_finite());
        finite.then(|| ScanPoint {
            position_m: position,
            to_sensor: to_sensor.into(),
            sigma_m: point.range_sigma_m,
            amplitude: point.amplitude,
        })
    }
}
