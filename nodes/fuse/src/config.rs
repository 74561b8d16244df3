//! Which receivers there are, where they sit on the handset, and when one of them is left out.

use geometry::{METRES_PER_MM, rigid_from_wire};
use nalgebra::Isometry3;
use serde::{Deserialize, Serialize};
use wire::{RigidPose, topic};

/// The receivers and the bounds. Milliseconds, millimetres and degrees, because people write them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// 1 to 16 receivers. The first one's readings are the moments of the fused poses; where it tells none, the next one's.
    pub receivers: Vec<Receiver>,
    /// A receiver's readings further apart are not interpolated between: it is left out there. 40 ms leaves room for three
    /// readings that are missing of 100 a second.
    pub most_gap_ms: f64,
    /// When the others are so far past a moment, they go on without a receiver that tells nothing of it. At a fast pace
    /// the sources run ahead of one another, so there it takes 5 s on the clock on the wall as well.
    pub most_wait_ms: f64,
    /// Readings of degraded quality are used as well, with the sigma that they state.
    pub use_degraded: bool,
    /// How far a receiver stands from where the others have it, along one axis, beyond the noise that it states: the
    /// mounting was measured with a ruler, and the room's field differs by some tenths over a hand's breadth.
    pub apart_mm: f64,
    /// The same of its orientation, about one axis.
    pub apart_deg: f64,
    /// Receivers that are farther apart than noise would set them, but for the chance of so many standard deviations,
    /// contradict each other: the one without which the others agree best is left out, as long as more than half of them
    /// agree.
    pub outlier_sigmas: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            receivers: Vec::new(),
            most_gap_ms: 40.0,
            most_wait_ms: 200.0,
            use_degraded: true,
            apart_mm: 1.0,
            apart_deg: 0.5,
            outlier_sigmas: 5.0,
        }
    }
}

/// One receiver on the handset: `tracker/<tracker>/pose`, and where it sits (body_from_receiver).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Receiver {
    /// Whose poses these are: the instance of a tracker.
    pub tracker: String,
    /// The receiver's origin in the frame of the body, in metres.
    #[serde(default)]
    pub translation_m: [f64; 3],
    /// The receiver's axes in the frame of the body: a unit quaternion w, x, y, z.
    #[serde(default = "unturned")]
    pub rotation_wxyz: [f64; 4],
}

fn unturned() -> [f64; 4] {
    RigidPose::IDENTITY.rotation_wxyz
}

/// A setting that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("fuse: {key} = {value}: {wanted}")]
pub struct ConfigError {
    /// The key.
    pub key: &'static str,
    /// What it holds.
    pub value: String,
    /// What it should hold.
    pub wanted: &'static str,
}

/// More are not fused: the search for the ones that agree grows with their square.
const MOST_RECEIVERS: usize = 16;
/// No handset is larger.
const LONGEST_ARM_M: f64 = 2.0;

impl Receiver {
    /// body_from_receiver; `None` when the numbers are no rigid transform on a handset.
    pub fn body_from_receiver(&self) -> Option<Isometry3<f64>> {
        let pose = RigidPose { translation_m: self.translation_m, rotation_wxyz: self.rotation_wxyz };
        rigid_from_wire(&pose).filter(|mount| mount.translation.vector.norm() <= LONGEST_ARM_M)
    }
}

impl Config {
    /// Refuses what makes no sense.
    pub fn check(&self) -> Result<(), ConfigError> {
        let refuse = |key, value: String, wanted| Err(ConfigError { key, value, wanted });
        if !(1..=MOST_RECEIVERS).contains(&self.receivers.len()) {
            let wanted = "1 to 16 receivers, each { tracker, translation_m, rotation_wxyz }";
            return refuse("receivers", format!("{} of them", self.receivers.len()), wanted);
        }
        for (index, receiver) in self.receivers.iter().enumerate() {
            let name = &receiver.tracker;
            if topic::check_name(name).is_err() {
                return refuse("tracker", format!("{name:?}"), "the instance of a tracker: 1 to 40 of a-z, 0-9 and _");
            }
            if self.receivers[..index].iter().any(|other| other.tracker == *name) {
                return refuse("tracker", format!("{name:?}"), "a tracker is one receiver: name each once");
            }
            if receiver.body_from_receiver().is_none() {
                let value = format!("{:?}, {:?} of {name}", receiver.translation_m, receiver.rotation_wxyz);
                return refuse("translation_m, rotation_wxyz", value, "metres on a handset, and a unit quaternion");
            }
        }
        for (key, value, bounds, wanted) in [
            ("most_gap_ms", self.most_gap_ms, 1.0..=1e4, "1 ms to 10 s"),
            ("most_wait_ms", self.most_wait_ms, 1.0..=400.0, "1 to 400 ms: a source runs no farther ahead"),
            ("apart_mm", self.apart_mm, 0.0..=1e3, "0 to 1000 mm"),
            ("apart_deg", self.apart_deg, 0.0..=90.0, "0 to 90 degrees"),
            ("outlier_sigmas", self.outlier_sigmas, 3.0..=100.0, "3 to 100, or noise is thrown away"),
        ] {
            if !bounds.contains(&value) {
                return refuse(key, value.to_string(), wanted);
            }
        }
        Ok(())
    }

    pub(crate) fn most_gap_nanos(&self) -> i64 {
        (self.most_gap_ms * 1e6) as i64
    }

    pub(crate) fn most_wait_nanos(&self) -> i64 {
        (self.most_wait_ms * 1e6) as i64
    }

    /// Metres and radians that are added to what a receiver states, in quadrature.
    pub(crate) fn apart(&self) -> [f64; 2] {
        [self.apart_mm * METRES_PER_MM, self.apart_deg.to_radians()]
    }
}
