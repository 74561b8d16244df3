//! A hand on a way that is known exactly, and a tracker with white noise.

#![allow(dead_code, reason = "each test uses a part")]

use geometry::TimedPose;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::TAU;

pub const MS: i64 = 1_000_000;

/// Amplitude, frequency in Hz and phase of the sways of one axis, in units of the rms of each band.
const SLOW: [[f64; 3]; 3] = [[0.9, 0.43, 0.3], [0.8, 1.1, 1.7], [0.7, 2.6, 4.0]];
const TREMOR: [[f64; 3]; 3] = [[0.8, 8.3, 0.9], [0.9, 9.7, 2.2], [0.7, 11.6, 5.1]];

fn sway(bands: &[[f64; 3]], t: f64, axis: usize) -> f64 {
    let shift = axis as f64 * 2.1;
    bands.iter().map(|[size, hz, phase]| size * (TAU * (hz + 0.07 * axis as f64) * t + phase + shift).sin()).sum()
}

/// A hand that sweeps at 50 mm/s, sways by 3 mm and 1.5 degrees up to 3 Hz, and trembles.
#[derive(Debug, Clone, Copy)]
pub struct Hand {
    pub tremor_m: f64,
    pub tremor_deg: f64,
}

impl Hand {
    /// What a hand does.
    pub const USUAL: Self = Self { tremor_m: 0.3e-3, tremor_deg: 0.2 };

    pub fn at(&self, stamp_nanos: i64) -> Isometry3<f64> {
        let t = stamp_nanos as f64 * 1e-9;
        let axes = |slow: f64, fast: f64| {
            // The vector, not each axis, has the length that is named.
            let axis = |axis| (slow * sway(&SLOW, t, axis) + fast * sway(&TREMOR, t, axis)) / 3f64.sqrt();
            Vector3::new(axis(0), axis(1), axis(2))
        };
        let sweep = Vector3::new(0.1 * (0.5 * t).sin(), 0.05 * (0.31 * t).cos(), 0.3);
        let turn = axes(1.5f64.to_radians(), self.tremor_deg.to_radians());
        let round = UnitQuaternion::new(Vector3::new(0.1, 0.2, 1.0) * (0.4 * t));
        Isometry3::from_parts(Translation3::from(sweep + axes(3e-3, self.tremor_m)), round * UnitQuaternion::new(turn))
    }
}

/// Numbers without pattern (Steele, Lea and Flood 2014), made Gaussian (Box and Muller 1958).
pub struct Noise(pub u64);

impl Noise {
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn gaussian(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (TAU * self.uniform()).cos()
    }

    pub fn vector(&mut self, rms_length: f64) -> Vector3<f64> {
        Vector3::new(self.gaussian(), self.gaussian(), self.gaussian()) * (rms_length / 3f64.sqrt())
    }
}

/// Noise as the rms length of the vector.
#[derive(Debug, Clone, Copy)]
pub struct Tracker {
    pub noise_m: f64,
    pub noise_deg: f64,
}

impl Tracker {
    /// The paper's.
    pub const PAPER: Self = Self { noise_m: 1.5e-3, noise_deg: 3.0 };
    /// A good optical one.
    pub const FINE: Self = Self { noise_m: 0.05e-3, noise_deg: 0.02 };

    pub fn read(&self, hand: &Hand, stamp_nanos: i64, noise: &mut Noise) -> TimedPose {
        let truth = hand.at(stamp_nanos);
        let translation = Translation3::from(truth.translation.vector + noise.vector(self.noise_m));
        let rotation = truth.rotation * UnitQuaternion::new(noise.vector(self.noise_deg.to_radians()));
        TimedPose {
            stamp_nanos,
            pose: Isometry3::from_parts(translation, rotation),
            position_sigma_m: self.noise_m / 3f64.sqrt(),
            rotation_sigma_rad: self.noise_deg.to_radians() / 3f64.sqrt(),
        }
    }

    /// At 100 Hz.
    pub fn readings(&self, hand: &Hand, seconds: i64, seed: u64) -> Vec<TimedPose> {
        let mut noise = Noise(seed);
        (0..seconds * 100).map(|i| self.read(hand, i * 10 * MS, &mut noise)).collect()
    }
}

/// How far poses are from the hand: rms length in mm and degrees.
pub fn rms(hand: &Hand, poses: impl Iterator<Item = (i64, Isometry3<f64>)>) -> (f64, f64) {
    let (mut position, mut rotation, mut count) = (0.0, 0.0, 0.0);
    for (stamp, pose) in poses {
        let truth = hand.at(stamp);
        position += (pose.translation.vector - truth.translation.vector).norm_squared();
        rotation += pose.rotation.angle_to(&truth.rotation).powi(2);
        count += 1.0;
    }
    ((position / count).sqrt() * 1e3, (rotation / count).sqrt().to_degrees())
}
