//! What an honest tracker says of the hand: the truth, late, smoothed, bent by the room, noisy, rounded, sometimes lost.

mod field;
mod filter;
mod section;

pub use section::TrackerSection;

use crate::random::{normal, normal3, uniform, word};
use crate::{Hand, Simulation, SimulationError};
use field::Field;
use geometry::{METRES_PER_MM, Rig, rigid_to_wire};
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use wire::{Clock, Header, Pose, Quality};

/// A tracker that watches a hand; every reading is a pure function of (rig, hand, seed, index).
#[derive(Debug, Clone)]
pub struct Tracker {
    section: TrackerSection,
    hand: Hand,
    field: Field,
    seed: u64,
}

/// The tracker runs before the sweep and behind it, so that every frame has readings on both sides.
const MARGIN_S: f64 = 0.3;
/// A stamp never wanders into its neighbour's.
const JITTER_SHARE: f64 = 0.3;
/// The coloured noise forgets what is older than so many correlation times.
const DRIFT_MEMORY: f64 = 7.0;
/// No gap is longer than so many readings.
const LONGEST_GAP: u64 = 60;

/// Independent streams of random numbers.
#[derive(Clone, Copy)]
enum Stream {
    Field = 1,
    Position,
    Rotation,
    DriftPosition,
    DriftRotation,
    Jitter,
    Drop,
}

impl Tracker {
    /// The tracker that the rig describes.
    pub fn new(rig: &Rig, hand: Hand, seed: u64) -> Result<Self, SimulationError> {
        let section = Simulation::from_rig(rig)?.tracker;
        let seed = seed.wrapping_mul(0x5851_f42d_4c95_7f2d) ^ 0x7ac3;
        let field = Field::new(&section, seed.wrapping_add(Stream::Field as u64));
        Ok(Self { section, hand, field, seed })
    }

    /// As another receiver of the same tracker has it: noise, stamps and drop-outs are its own, the room is the same.
    pub fn of_receiver(self, name: &str) -> Self {
        Self { seed: name.bytes().fold(self.seed, |seed, byte| word(seed, u64::from(byte))), ..self }
    }

    /// How many readings the sweep has, lost ones included.
    pub fn count(&self) -> u64 {
        ((self.hand.duration_s() + 2.0 * MARGIN_S) * self.section.rate_hz).floor() as u64 + 1
    }

    /// The true moment of a reading, in seconds from the start of the sweep.
    pub fn time_s(&self, index: u64) -> f64 {
        index as f64 / self.section.rate_hz - MARGIN_S
    }

    /// A reading, with `seq` 0 for the publisher to count; `None` when it is lost. Readings behind the sweep keep its
    /// phase: `End` travels once, behind all of them.
    pub fn sample(&self, index: u64) -> Option<Pose> {
        if self.is_lost(index) {
            return None;
        }
        let t_s = self.time_s(index);
        let world_from_body = self.distorted(t_s, index);
        let per_axis = 1.0 / 3f64.sqrt();
        let position_sigma = self.section.position_noise_mm * METRES_PER_MM * per_axis;
        let rotation_sigma = self.section.rotation_noise_deg.to_radians() * per_axis;
        Some(Pose {
            header: Header {
                phase: self.hand.phase(t_s.min(self.hand.duration_s().next_down())),
                stamp_nanos: self.stamp_nanos(index),
                clock: Clock::Scan,
                ..Header::default()
            },
            world_from_body: rigid_to_wire(&world_from_body),
            position_sigma_m: [position_sigma; 3],
            rotation_sigma_rad: [rotation_sigma; 3],
            rotation_lag_nanos: 0,
            quality: Quality::Good,
            reason: String::new(),
        })
    }

    /// world_from_body as it shows it at any moment, with the noise of the nearest reading: for a device that measures in
    /// its own time, and has latency, clock and losses of its own.
    pub fn at(&self, t_s: f64) -> Isometry3<f64> {
        let index = ((t_s + MARGIN_S) * self.section.rate_hz).round().max(0.0) as u64;
        self.distorted(t_s, index)
    }

    fn stream(&self, stream: Stream) -> u64 {
        self.seed.wrapping_add(stream as u64)
    }

    fn distorted(&self, t_s: f64, index: u64) -> Isometry3<f64> {
        let section = &self.section;
        let smooth = filter::filtered(section, &self.hand, t_s);
        let [mut shift, mut turn] = self.field.at(&Point3::from(smooth.translation.vector));
        let per_axis = 1.0 / 3f64.sqrt();
        let [metres, radians] = [METRES_PER_MM * per_axis, per_axis.to_radians()];
        shift += normal3(self.stream(Stream::Position), index) * (section.position_noise_mm * metres);
        turn += normal3(self.stream(Stream::Rotation), index) * (section.rotation_noise_deg * radians);
        shift += self.drift(Stream::DriftPosition, section.drift_position_mm * metres, index);
        turn += self.drift(Stream::DriftRotation, section.drift_rotation_deg * radians, index);
        let position = smooth.translation.vector + shift;
        let rotation = smooth.rotation * UnitQuaternion::new(turn);
        Isometry3::from_parts(
            Translation3::from(position.map(|x| rounded(x, section.position_step_mm * METRES_PER_MM))),
            rounded_rotation(&rotation, section.rotation_step_deg.to_radians()),
        )
    }

    /// Ornstein-Uhlenbeck noise at a sample, as the weighted sum of the white noise until then.
    fn drift(&self, stream: Stream, sigma: f64, index: u64) -> Vector3<f64> {
        if sigma == 0.0 {
            return Vector3::zeros();
        }
        let keep = (-1.0 / (self.section.rate_hz * self.section.drift_time_s)).exp();
        let memory = (DRIFT_MEMORY * self.section.rate_hz * self.section.drift_time_s).ceil() as u64;
        let past = |back: u64| normal3(self.stream(stream), index + memory - back) * keep.powf(back as f64);
        (0..=memory).map(past).sum::<Vector3<f64>>() * (sigma * (1.0 - keep * keep).sqrt())
    }

    fn stamp_nanos(&self, index: u64) -> i64 {
        let section = &self.section;
        let limit = JITTER_SHARE / section.rate_hz;
        let jitter = (normal(self.stream(Stream::Jitter), index) * section.stamp_jitter_s).clamp(-limit, limit);
        ((self.time_s(index) + section.latency_s + section.clock_offset_s + jitter) * 1e9).round() as i64
    }

    /// Gaps begin at random and last for a random (geometric) number of readings.
    fn is_lost(&self, index: u64) -> bool {
        let section = &self.section;
        if section.dropped == 0.0 {
            return false;
        }
        let go_on = 1.0 - 1.0 / section.dropped_in_a_row;
        // Gaps may overlap, which this makes up for when few are lost.
        let begin = 1.0 - (1.0 - section.dropped).powf(1.0 / section.dropped_in_a_row);
        (0..LONGEST_GAP.min(index + 1)).any(|back| {
            let start = index - back;
            let seed = self.stream(Stream::Drop);
            uniform(seed, 2 * start) < begin && uniform(seed, 2 * start + 1) < go_on.powf(back as f64)
        })
    }
}

fn rounded(value: f64, step: f64) -> f64 {
    if step > 0.0 { (value / step).round() * step } else { value }
}

/// The Flock reports azimuth, elevation and roll as whole numbers of steps.
fn rounded_rotation(rotation: &UnitQuaternion<f64>, step: f64) -> UnitQuaternion<f64> {
    if step <= 0.0 {
        return *rotation;
    }
    let (roll, elevation, azimuth) = rotation.euler_angles();
    UnitQuaternion::from_euler_angles(rounded(roll, step), rounded(elevation, step), rounded(azimuth, step))
}
