//! What has come so far: readings, frames and their points; and what was refused, by reason.

use crate::clock::{BadStamp, StampGuard};
use geometry::{TimedPose, rigid_from_wire};
use std::collections::BTreeMap;
use std::sync::Arc;
use wire::{Header, Phase, Pose, Profile, ProfilePoint, Quality, Refusal};

/// One laser-lit picture.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub header: Header,
    /// In the frame of the camera; shared with the refinements that were given out.
    pub points: Arc<[ProfilePoint]>,
    /// How many points came before them.
    pub first: usize,
}

impl Frame {
    pub fn stamp_nanos(&self) -> i64 {
        self.header.stamp_nanos
    }
}

/// The present scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct Gathered {
    scan: Option<u64>,
    /// world_from_body on the camera's clock.
    pub readings: Vec<TimedPose>,
    /// The moment of each reading's rotation, which some trackers sample earlier than the position.
    pub rotation_stamps: Vec<i64>,
    reading_clock: StampGuard,
    /// In the order of their stamps.
    pub frames: Vec<Frame>,
    frame_clock: StampGuard,
    /// How many points all frames have.
    pub points: usize,
    refused: BTreeMap<&'static str, u64>,
}

const OTHER_SCAN: &str = "message of another scan";
const AIMING: &str = "profile taken while aiming";
const NOT_RIGID: &str = "pose that is no rigid transform or has no sigma";
const LOST: &str = "pose that the tracker calls lost";
const DEGRADED: &str = "pose that the tracker calls degraded";
const BAD_POINT: &str = "point that is not finite, has no sigma or lies behind the camera";

impl Gathered {
    /// Takes a reading; its stamp plus `offset_nanos` is the camera's clock.
    pub fn pose(&mut self, pose: &Pose, offset_nanos: i64, use_degraded: bool) {
        if !self.belongs(&pose.header) {
            return;
        }
        match pose.quality {
            Quality::Lost => return self.refuse(LOST, 1),
            Quality::Degraded if !use_degraded => return self.refuse(DEGRADED, 1),
            _ => {}
        }
        let sigma = |axes: [f64; 3]| {
            let good = axes.iter().all(|sigma| (0.0..FARTHEST_M).contains(sigma));
            good.then(|| axes.into_iter().fold(0.0, f64::max))
        };
        let sigmas = sigma(pose.position_sigma_m).zip(sigma(pose.rotation_sigma_rad));
        let Some((world_from_body, (position_sigma_m, rotation_sigma_rad))) =
            rigid_from_wire(&pose.world_from_body).filter(is_near).zip(sigmas)
        else {
            return self.refuse(NOT_RIGID, 1);
        };
        let stamp_nanos = pose.header.stamp_nanos.saturating_add(offset_nanos);
        match self.reading_clock.admit(stamp_nanos) {
            Err(BadStamp::Backwards) => return self.refuse("pose whose time goes backwards", 1),
            Err(BadStamp::Jump) => return self.refuse("pose whose time is far from the one before", 1),
            Ok(()) => {}
        }
        self.readings.push(TimedPose { stamp_nanos, pose: world_from_body, position_sigma_m, rotation_sigma_rad });
        self.rotation_stamps.push(stamp_nanos.saturating_sub(pose.rotation_lag_nanos));
    }

    /// Takes the points of a picture.
    pub fn profile(&mut self, profile: &Profile) {
        if !self.belongs(&profile.header) {
            return;
        }
        if profile.header.phase == Phase::Aim {
            return self.refuse(AIMING, 1);
        }
        match self.frame_clock.admit(profile.header.stamp_nanos) {
            Err(BadStamp::Backwards) => return self.refuse("profile whose time goes backwards", 1),
            Err(BadStamp::Jump) => return self.refuse("profile whose time is far from the one before", 1),
            Ok(()) => {}
        }
        let points: Arc<[ProfilePoint]> = profile.points.iter().copied().filter(is_good).collect();
        self.refuse(BAD_POINT, (profile.points.len() - points.len()) as u64);
        // A picture without the laser's line says nothing about where it was taken.
        if !points.is_empty() {
            let first = self.points;
            self.points += points.len();
            self.frames.push(Frame { header: profile.header, points, first });
        }
    }

    /// The number of the scan that is gathered; `None` before its first message.
    pub fn scan(&self) -> Option<u64> {
        self.scan
    }

    /// What was refused since the beginning.
    pub fn refused(&self) -> Vec<Refusal> {
        let refusal = |(reason, count): (&&str, &u64)| Refusal { reason: (*reason).to_owned(), count: *count };
        self.refused.iter().map(refusal).collect()
    }

    fn belongs(&mut self, header: &Header) -> bool {
        if header.is_end() {
            return false;
        }
        let ours = *self.scan.get_or_insert(header.scan) == header.scan;
        if !ours {
            self.refuse(OTHER_SCAN, 1);
        }
        ours
    }

    fn refuse(&mut self, reason: &'static str, count: u64) {
        if count > 0 {
            *self.refused.entry(reason).or_default() += count;
        }
    }
}

/// No tracker reaches so far; numbers beyond it overflow in single precision.
const FARTHEST_M: f64 = 1e4;

fn is_near(world_from_body: &nalgebra::Isometry3<f64>) -> bool {
    world_from_body.translation.vector.amax() < FARTHEST_M
}

fn is_good(point: &ProfilePoint) -> bool {
    let finite = point.position_m.iter().all(|x| x.is_finite() && x.abs() < 100.0);
    let sigmas = [point.range_sigma_m, point.lateral_sigma_m].iter().all(|s| (0.0..100.0).contains(s));
    finite && sigmas && point.position_m[2] > 0.0
}
