//! R(t) x + p(t) (paper, section 2.3).

use crate::place::Place;
use crate::readings::{KEPT_NANOS, Readings};
use crate::{Config, ConfigError};
use geometry::{NoPose, SmoothError, TimedPose, rigid_from_wire, rigid_to_wire};
use nalgebra::Isometry3;
use std::collections::{BTreeMap, VecDeque};
use wire::{Bulk, Calibration, Extent, Header, Phase, Pose, Profile, Refusal, Scan, Trajectory};

/// Why nothing can be registered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RegisterError {
    /// The bounds.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The bounds of the smoother.
    #[error(transparent)]
    Smooth(#[from] SmoothError),
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
    /// Of the present scan; `None` before the first message.
    header: Option<Header>,
    /// The present scan may give way to the next.
    finished: bool,
    readings: Readings,
    /// What a scan begins with.
    no_readings: Readings,
    /// Readings of the next scan that came before the last profiles of this one.
    next: Option<(Header, Readings)>,
    waiting: VecDeque<Profile>,
    registered: VecDeque<Scan>,
    /// The last profile that got no pose, when nothing was registered behind it.
    passed_over: Option<Header>,
    /// What is left to tell of scans before this one.
    older_ways: VecDeque<Trajectory>,
    refused: BTreeMap<&'static str, u64>,
}

const TIMED_OUT: &str = "profile without a pose behind it in time";
const TOO_MANY: &str = "profile, because too many waited for poses";
const BACKWARDS: &str = "profile whose time goes backwards";
const FAR_AHEAD: &str = "profile whose time is far ahead of the poses";
const OLD_PROFILE: &str = "profile of an older scan";
const OLD_POSE: &str = "pose of an older scan";
const AIMING: &str = "profile taken while aiming";
const NOT_FINITE: &str = "point that is not finite";

impl Register {
    /// For one calibrated handset.
    pub fn new(config: Config, calibration: &Calibration) -> Result<Self, RegisterError> {
        config.check()?;
        let no_readings = Readings::new(&config)?;
        let hand_eye = calibration.body_from_camera;
        Ok(Self {
            config,
            body_from_camera: rigid_from_wire(&hand_eye).ok_or(RegisterError::HandEye(hand_eye))?,
            offset_nanos: calibration.pose_offset_nanos,
            header: None,
            finished: false,
            readings: no_readings.clone(),
            no_readings,
            next: None,
            waiting: VecDeque::new(),
            registered: VecDeque::new(),
            passed_over: None,
            older_ways: VecDeque::new(),
            refused: BTreeMap::new(),
        })
    }

    /// Takes a reading of the tracker. One of a higher scan waits until a profile of that scan has come, or until this
    /// scan is finished, because the last profiles of this scan may still be on their way.
    pub fn pose(&mut self, pose: &Pose) {
        let header = pose.header;
        match self.header {
            Some(present) if header.scan < present.scan => return self.refuse(OLD_POSE, 1),
            Some(present) if header.scan > present.scan && !self.finished => return self.pose_of_next(pose),
            Some(present) if header.scan == present.scan => {}
            _ => self.begin(&header),
        }
        if let Some(present) = &mut self.header {
            present.phase = header.phase;
        }
        match self.readings.take(pose, self.offset_nanos) {
            Ok(()) => self.serve(),
            Err(bad) => self.refuse(bad.reason(), 1),
        }
    }

    fn pose_of_next(&mut self, pose: &Pose) {
        let header = pose.header;
        match &self.next {
            Some((next, _)) if header.scan < next.scan => return self.refuse(OLD_POSE, 1),
            // Two scans ahead: of the present one nothing comes any more.
            Some((next, _)) if header.scan > next.scan => {
                let next = *next;
                self.begin(&next);
                self.next = Some((header, self.no_readings.clone()));
            }
            Some(_) => {}
            None => self.next = Some((header, self.no_readings.clone())),
        }
        if let Some((_, readings)) = &mut self.next
            && let Err(bad) = readings.take(pose, self.offset_nanos)
        {
            self.refuse(bad.reason(), 1);
        }
    }

    /// Takes a profile. A higher scan number starts afresh.
    pub fn profile(&mut self, profile: Profile) {
        let header = profile.header;
        match self.header {
            Some(present) if header.scan < present.scan => return self.refuse(OLD_PROFILE, 1),
            Some(present) if header.scan == present.scan => {}
            _ => self.begin(&header),
        }
        if header.phase == Phase::Aim {
            return self.refuse(AIMING, 1);
        }
        if self.waiting.back().is_some_and(|last| header.stamp_nanos <= last.header.stamp_nanos) {
            return self.refuse(BACKWARDS, 1);
        }
        self.waiting.push_back(profile);
        self.serve();
        if self.waiting.len() > self.config.most_waiting {
            self.pass_over(TOO_MANY);
        }
    }

    /// The scans that are ready, in the order of their stamps.
    pub fn drain(&mut self) -> impl Iterator<Item = Scan> + '_ {
        self.registered.drain(..)
    }

    /// A scan without points that says what was refused, when profiles got no pose and none behind them did: whoever waits
    /// for the scans goes on without them. Call it when [`Register::drain`] has given all.
    pub fn without_pose(&mut self) -> Option<Scan> {
        let header = self.passed_over.take()?;
        Some(Scan { refused: self.take_refused(), ..Scan::none(header.derived()) })
    }

    /// Where the camera was at the readings since the last call, as far as that is known by now; `None` when there was
    /// none. The smooth way is told 0.25 to 0.3 s behind the newest reading, a twentieth of a second at a time; a reading
    /// whose rotation is older than its position, when the rotation at that moment is known; the rest once the scan is
    /// finished. After a new scan began, the first call tells the rest of the scan before.
    pub fn trajectory(&mut self) -> Option<Trajectory> {
        self.older_ways.pop_front().or_else(|| self.way(self.finished))
    }

    fn way(&mut self, ended: bool) -> Option<Trajectory> {
        let header = self.header?;
        let way = self.readings.tell(ended);
        let header = Header { stamp_nanos: way.last()?.stamp_nanos, ..header.derived() };
        let camera = |body: &TimedPose| TimedPose { pose: body.pose * self.body_from_camera, ..*body };
        Some(Trajectory { header, samples: way.iter().map(|body| (&camera(body)).into()).collect() })
    }

    /// No reading of this scan will come any more: what still waits is registered by the readings that there are, or
    /// refused. Returns what was refused and not yet told.
    pub fn finish(&mut self) -> Vec<Refusal> {
        self.give_up_waiting();
        self.finished = true;
        self.take_refused()
    }

    fn give_up_waiting(&mut self) {
        for profile in std::mem::take(&mut self.waiting) {
            match self.readings.at_end(profile.header.stamp_nanos) {
                Ok(body) => self.place(&profile, &body),
                Err(never) => self.refuse(unplaced(never), 1),
            }
        }
    }

    /// Starts a scan, with the readings of it that have come already.
    fn begin(&mut self, header: &Header) {
        self.give_up_waiting();
        let rest = self.way(true);
        self.older_ways.extend(rest);
        self.readings = match self.next.take() {
            Some((next, readings)) if next.scan == header.scan => readings,
            other => {
                self.next = other.filter(|(next, _)| next.scan > header.scan);
                self.no_readings.clone()
            }
        };
        self.header = Some(*header);
        self.finished = false;
    }

    /// Registers what has its poses by now.
    fn serve(&mut self) {
        while let Some(profile) = self.waiting.front() {
            let stamp_nanos = profile.header.stamp_nanos;
            match self.readings.at(stamp_nanos) {
                Ok(body) => {
                    let Some(profile) = self.waiting.pop_front() else { return };
                    self.place(&profile, &body);
                }
                Err(NoPose::After) if self.is_far_ahead(stamp_nanos) => self.pass_over(FAR_AHEAD),
                Err(NoPose::After) => {
                    let newest = self.waiting.back().map_or(stamp_nanos, |last| last.header.stamp_nanos);
                    if newest.saturating_sub(stamp_nanos) <= self.config.most_wait_nanos() {
                        return;
                    }
                    self.pass_over(TIMED_OUT);
                }
                Err(never) => self.pass_over(unplaced(never)),
            }
        }
    }

    /// The profile that has waited longest gets no pose.
    fn pass_over(&mut self, reason: &'static str) {
        self.passed_over = self.waiting.pop_front().map(|profile| profile.header);
        self.refuse(reason, 1);
    }

    fn is_far_ahead(&self, stamp_nanos: i64) -> bool {
        self.readings.newest().is_some_and(|newest| stamp_nanos.saturating_sub(newest) > KEPT_NANOS)
    }

    fn place(&mut self, profile: &Profile, body: &TimedPose) {
        let world_from_camera = body.pose * self.body_from_camera;
        let place = Place::new(&world_from_camera);
        let mut points = Vec::with_capacity(profile.points.len());
        points.extend(profile.points.iter().filter_map(|point| place.of(point)));
        self.refuse(NOT_FINITE, (profile.points.len() - points.len()) as u64);
        let refused = self.take_refused();
        self.passed_over = None;
        self.registered.push_back(Scan {
            header: profile.header.derived(),
            extent: Extent::Whole,
            world_from_camera: rigid_to_wire(&world_from_camera),
            position_sigma_m: body.position_sigma_m,
            rotation_sigma_rad: body.rotation_sigma_rad,
            region_sigma_m: 0.0,
            points: Bulk(points),
            refused,
        });
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
