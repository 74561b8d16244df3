//! What is said of one moment: the pose, how well it is known, and who is missing and why.

use crate::agree::{Agreement, Contradiction};
use crate::solve::Sighting;
use crate::track::Listening;
use geometry::{NoPose, rigid_to_wire};
use std::fmt::Write as _;
use wire::{Header, Pose, Quality};

/// Words on the receivers at one moment; empty when all of them are well.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Remarks(String);

impl Remarks {
    pub fn add(&mut self, receiver: &str, remark: std::fmt::Arguments<'_>) {
        let stop = if self.0.is_empty() { "" } else { "; " };
        // Writing into a text cannot fail.
        let _ = write!(self.0, "{stop}{receiver} {remark}");
    }
}

/// Why a receiver has no say at a moment.
pub(crate) fn absence(listening: Listening, why: NoPose) -> &'static str {
    match (why, listening) {
        (NoPose::Before, _) => "has told no pose yet",
        (NoPose::Gap, _) => "tells no pose around it",
        (NoPose::After, Listening::Ended) => "has ended",
        (NoPose::After, _) => "is silent",
    }
}

/// How far a receiver is from where the fused pose has it.
pub(crate) fn off(sighting: &Sighting, agreement: &Agreement) -> String {
    let [off_m, turn_rad] = sighting.residual(&agreement.solution.world_from_body).map(|residual| residual.norm());
    format!("is {:.1} mm and {:.1} degrees off the others", off_m * 1e3, turn_rad.to_degrees())
}

/// The pose that was agreed upon.
pub(crate) fn agreed(header: Header, agreement: &Agreement, remarks: Remarks) -> Pose {
    let covariance = &agreement.solution.covariance;
    let sigmas = |row: usize| [row, row + 1, row + 2].map(|axis| covariance[(axis, axis)].sqrt());
    Pose {
        header: header.derived(),
        world_from_body: rigid_to_wire(&agreement.solution.world_from_body),
        position_sigma_m: sigmas(0),
        rotation_sigma_rad: sigmas(3),
        rotation_lag_nanos: 0,
        quality: if remarks.0.is_empty() { Quality::Good } else { Quality::Degraded },
        reason: remarks.0,
    }
}

/// No pose, since nobody tells one.
pub(crate) fn nobody(header: Header, remarks: &Remarks) -> Pose {
    Pose::none(header.derived(), &remarks.0)
}

/// No pose, since the receivers contradict each other.
pub(crate) fn contradicted(header: Header, names: &[&str], contradiction: Contradiction) -> Pose {
    let (names, times) = (names.join(", "), contradiction.times);
    let reason = format!("{names} are {times:.0} times as far apart as they state: which is wrong cannot be told");
    Pose::none(header.derived(), &reason)
}
