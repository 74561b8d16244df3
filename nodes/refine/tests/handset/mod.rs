//! A handset that sweeps over plain shapes whose every point is known: to and fro over the table z = 0, with or without
//! steps in it, the stripe across the way.

#![allow(dead_code, reason = "each test needs its own part")]
#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use refine::{Config, Refiner};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use wire::*;

pub const POSE_NANOS: i64 = 10_000_000;
pub const FRAME_NANOS: i64 = 40_000_000;

pub fn calibration() -> Calibration {
    let camera =
        CameraIntrinsics { width: 640, height: 480, fx: 800.0, fy: 800.0, cx: 319.5, cy: 239.5, distortion: [0.0; 5] };
    let laser =
        LaserPlane { normal: [-0.8, 0.0, 0.6], distance_m: 0.12, channel_weights: [1.0; 3], peaks_per: PeaksPer::Row };
    let body_from_camera = RigidPose { translation_m: [0.03, -0.02, 0.01], ..RigidPose::IDENTITY };
    Calibration { header: Header::default(), camera, laser, body_from_camera, pose_offset_nanos: 0, name: "x".into() }
}

/// How the hand sweeps.
#[derive(Clone, Copy)]
pub struct Sweep {
    pub seconds: f64,
    /// The stripe is turned slowly, by up to a quarter.
    pub crossing: bool,
    /// The only stroke that is made.
    pub single: bool,
    /// Height of the steps in the table.
    pub steps_m: f64,
    /// The table is a dish of this radius; flat without.
    pub dish_m: Option<f64>,
    /// White noise of the tracker, metres and radians on each axis.
    pub noise: [f64; 2],
}

impl Default for Sweep {
    fn default() -> Self {
        Self { seconds: 24.0, crossing: true, single: false, steps_m: 0.0, dish_m: None, noise: [5e-4, 5e-3] }
    }
}

const SPAN_M: f64 = 0.06;

impl Sweep {
    pub fn world_from_camera(&self, t_s: f64) -> Isometry3<f64> {
        let wave = |period_s: f64| SPAN_M * (TAU * t_s / period_s).sin();
        let (x, y) =
            if self.single { (SPAN_M * (2.0 * t_s / self.seconds - 1.0), 0.0) } else { (wave(8.0), wave(6.3)) };
        let turned = self.crossing && !self.single;
        let roll = if turned { 0.5 * FRAC_PI_2 * (1.0 - (TAU * t_s / 11.0).cos()) } else { 0.0 };
        let down = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), roll)
            * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI);
        Isometry3::from_parts(Translation3::new(x, y, 0.2), down)
    }

    pub fn header(stamp_nanos: i64) -> Header {
        Header { stamp_nanos, phase: Phase::Shape, ..Header::default() }
    }

    pub fn poses(&self) -> Vec<Pose> {
        let hand_eye = geometry::rigid_from_wire(&calibration().body_from_camera).unwrap();
        let pose = |i: i64| {
            let t_s = (i * POSE_NANOS) as f64 * 1e-9;
            let truth = self.world_from_camera(t_s.clamp(0.0, self.seconds - 1e-6)) * hand_eye.inverse();
            let random = |k: u64| noise(6 * i.unsigned_abs() + k);
            let shift = Vector3::new(random(0), random(1), random(2)) * self.noise[0];
            let turn = Vector3::new(random(3), random(4), random(5)) * self.noise[1];
            let said = Isometry3::from_parts(
                Translation3::from(truth.translation.vector + shift),
                truth.rotation * UnitQuaternion::new(turn),
            );
            Pose {
                header: Self::header(i * POSE_NANOS),
                world_from_body: geometry::rigid_to_wire(&said),
                position_sigma_m: [self.noise[0]; 3],
                rotation_sigma_rad: [self.noise[1]; 3],
                rotation_lag_nanos: 0,
                quality: Quality::Good,
                reason: String::new(),
            }
        };
        (0..=(self.seconds * 100.0) as i64 + 10).map(pose).collect()
    }

    pub fn profiles(&self) -> Vec<Profile> {
        let profile = |k: i64| {
            let stamp_nanos = k * FRAME_NANOS + FRAME_NANOS / 2;
            let way = self.world_from_camera(stamp_nanos as f64 * 1e-9);
            let point = |i: i32| {
                let flat = Point3::new(0.0, 6e-4 * f64::from(i), 0.2);
                let below = way * flat;
                let odd = (below.x / 0.03).floor() as i64 + (below.y / 0.03).floor() as i64;
                let step = if odd.rem_euclid(2) == 1 { self.steps_m } else { 0.0 };
                let height = step + self.dish_m.map_or(0.0, |radius| below.coords.xy().norm_squared() / (2.0 * radius));
                let range = 0.2 - height + 5e-5 * noise((k * 1000) as u64 + i.unsigned_abs() as u64 * 2 + 7);
                let position = flat.coords * (range / 0.2);
                ProfilePoint {
                    position_m: position.cast::<f32>().into(),
                    range_sigma_m: 5e-5,
                    lateral_sigma_m: 1e-5,
                    amplitude: 100.0,
                    line: i.unsigned_abs(),
                }
            };
            Profile { header: Self::header(stamp_nanos), points: (-50..50).map(point).collect(), refused: vec![] }
        };
        (0..(self.seconds * 1e9) as i64 / FRAME_NANOS).map(profile).collect()
    }

    pub fn refiner(&self) -> Refiner {
        told(&self.poses(), &self.profiles())
    }
}

/// A refiner that has heard all of these.
pub fn told(poses: &[Pose], profiles: &[Profile]) -> Refiner {
    let mut refiner = Refiner::new(Config::default(), &calibration()).unwrap();
    poses.iter().for_each(|pose| refiner.pose(pose));
    profiles.iter().for_each(|profile| refiner.profile(profile));
    refiner
}

/// Normal, mean 0, deviation 1.
fn noise(index: u64) -> f64 {
    let uniform = |i: u64| {
        let mut z = i.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    };
    (-2.0 * uniform(2 * index).ln()).sqrt() * (TAU * uniform(2 * index + 1)).cos()
}
