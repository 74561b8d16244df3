//! A handset with receivers on it, on a way that is known exactly.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]
#![allow(dead_code, reason = "each test takes what it needs")]

use fuse::{Config, Fuse, Receiver};
use geometry::{rigid_from_wire, rigid_to_wire};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use wire::{Header, Phase, Pose, Quality};

pub const MS: i64 = 1_000_000;
pub const ARM_M: f64 = 0.1;
pub const NAMES: [&str; 3] = ["top", "left", "right"];

/// A receiver at the end of an arm in the x-y plane, turned with it.
pub fn on_arm(tracker: &str, degrees: f64) -> Receiver {
    let angle = degrees.to_radians();
    let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, angle).into_inner();
    Receiver {
        tracker: tracker.to_owned(),
        translation_m: [ARM_M * angle.cos(), ARM_M * angle.sin(), 0.0],
        rotation_wxyz: [turn.w, turn.i, turn.j, turn.k],
    }
}

/// Three at the corners of a triangle around the body's origin, each 10 cm from it; they state all that they are apart.
pub fn triangle() -> Config {
    let receivers = NAMES.iter().zip([90.0, 210.0, 330.0]).map(|(name, degrees)| on_arm(name, degrees)).collect();
    Config { receivers, apart_mm: 0.0, apart_deg: 0.0, ..Config::default() }
}

pub fn fuse(config: Config) -> Fuse {
    Fuse::new(config).unwrap()
}

/// Turns at a constant rate while it moves at a constant speed.
pub fn world_from_body(stamp_nanos: i64) -> Isometry3<f64> {
    let t = stamp_nanos as f64 * 1e-9;
    let rotation =
        UnitQuaternion::new(Vector3::new(0.2, 0.5, -0.3) * t) * UnitQuaternion::from_euler_angles(1.0, 0.0, 0.5);
    Isometry3::from_parts(Translation3::new(0.3 + 0.1 * t, -0.05 * t, 0.4), rotation)
}

pub fn reading(stamp_nanos: i64, world_from_receiver: &Isometry3<f64>) -> Pose {
    Pose {
        header: Header { scan: 1, stamp_nanos, phase: Phase::Both, ..Header::default() },
        world_from_body: rigid_to_wire(world_from_receiver),
        position_sigma_m: [1e-3; 3],
        rotation_sigma_rad: [0.03; 3],
        rotation_lag_nanos: 0,
        quality: Quality::Good,
        reason: String::new(),
    }
}

/// What a receiver says when it errs by so much: metres along the axes of the world, radians about its own.
pub fn erring(config: &Config, receiver: usize, stamp_nanos: i64, off: Vector3<f64>, turn: Vector3<f64>) -> Pose {
    let mount = config.receivers[receiver].body_from_receiver().unwrap();
    let truth = world_from_body(stamp_nanos) * mount;
    let said = Isometry3::from_parts(
        Translation3::from(truth.translation.vector + off),
        truth.rotation * UnitQuaternion::new(turn),
    );
    reading(stamp_nanos, &said)
}

/// What a receiver says when it does not err.
pub fn true_reading(config: &Config, receiver: usize, stamp_nanos: i64) -> Pose {
    erring(config, receiver, stamp_nanos, Vector3::zeros(), Vector3::zeros())
}

pub fn end(stamp_nanos: i64) -> Pose {
    Pose::none(Header { scan: 1, stamp_nanos, phase: Phase::End, ..Header::default() }, "the scan has ended")
}

/// Error of a fused pose: metres along the axes of the world, radians about the axes of the body.
pub fn error(pose: &Pose) -> [Vector3<f64>; 2] {
    let (truth, said) = (world_from_body(pose.header.stamp_nanos), rigid_from_wire(&pose.world_from_body).unwrap());
    let turn = (truth.rotation.inverse() * said.rotation).scaled_axis();
    [said.translation.vector - truth.translation.vector, turn]
}

pub fn stamps_ms(poses: &[Pose]) -> Vec<i64> {
    poses.iter().map(|pose| pose.header.stamp_nanos / MS).collect()
}

/// Normal numbers from a counter (SplitMix64; Box and Muller).
pub struct Noise(pub u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    pub fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }

    pub fn vector(&mut self, sigma: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.normal() * sigma)
    }
}
