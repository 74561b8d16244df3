//! Poses at moments between readings: smooth, or straight from one reading to the next.

use crate::Config;
use geometry::{FixedLagSmoother, NoPose, SmoothError, Smoothing, TimedPose, TrajectoryBuffer, Wait};
use nalgebra::Isometry3;

/// One of the two ways to come by a pose; `world_from_body`.
#[derive(Debug, Clone)]
pub(crate) enum Between {
    Smooth { smoother: Box<FixedLagSmoother>, wait: Wait },
    Straight(Straight),
}

/// Samples of the camera's way are told so long behind the newest reading: from then on they gain nothing any more.
const WAY_LAG_NANOS: i64 = 250_000_000;

impl Between {
    pub(crate) fn new(config: &Config) -> Result<Self, SmoothError> {
        if !config.smooth {
            return Ok(Self::Straight(Straight { gap_nanos: config.most_gap_nanos(), ..Straight::default() }));
        }
        let smoothing = Smoothing { most_gap_ms: config.most_gap_ms, ..Smoothing::default() };
        Ok(Self::Smooth { smoother: Box::new(FixedLagSmoother::new(smoothing)?), wait: config.wait() })
    }

    pub(crate) fn clear(&mut self) {
        match self {
            Self::Smooth { smoother, .. } => smoother.clear(),
            Self::Straight(straight) => *straight = Straight { gap_nanos: straight.gap_nanos, ..Straight::default() },
        }
    }

    /// Takes a reading whose rotation was sampled so long before its position; `false` when it is not later than the last.
    pub(crate) fn push(&mut self, reading: &TimedPose, rotation_lag_nanos: i64) -> bool {
        match self {
            Self::Smooth { smoother, .. } => smoother.push(reading, rotation_lag_nanos),
            Self::Straight(straight) => straight.push(reading, rotation_lag_nanos),
        }
    }

    /// Stamps of the oldest and the newest reading.
    pub(crate) fn span(&self) -> Option<(i64, i64)> {
        match self {
            Self::Smooth { smoother, .. } => smoother.oldest().zip(smoother.newest()),
            Self::Straight(straight) => {
                let samples = straight.positions.samples();
                samples.first().zip(samples.last()).map(|(first, last)| (first.stamp_nanos, last.stamp_nanos))
            }
        }
    }

    pub(crate) fn forget_before(&mut self, stamp_nanos: i64) {
        match self {
            Self::Smooth { smoother, .. } => smoother.forget_before(stamp_nanos),
            Self::Straight(straight) => {
                straight.positions.forget_before(stamp_nanos);
                straight.rotations.forget_before(stamp_nanos);
            }
        }
    }

    /// For a profile, as soon as it is known well enough.
    pub(crate) fn at(&self, stamp_nanos: i64) -> Result<TimedPose, NoPose> {
        match self {
            Self::Smooth { smoother, wait } => smoother.at(stamp_nanos, wait),
            Self::Straight(straight) => straight.at(stamp_nanos),
        }
    }

    /// For the camera's way, which can wait: of the first one or more of these moments.
    pub(crate) fn settled(&self, moments: &[i64]) -> Result<Vec<Result<TimedPose, NoPose>>, NoPose> {
        match self {
            Self::Smooth { smoother, .. } => smoother.settled(moments, WAY_LAG_NANOS),
            Self::Straight(straight) => match moments.first().map(|moment| straight.at(*moment)) {
                Some(Err(NoPose::After)) => Err(NoPose::After),
                first => Ok(Vec::from_iter(first)),
            },
        }
    }

    /// When no reading will come any more.
    pub(crate) fn at_end(&self, stamp_nanos: i64) -> Result<TimedPose, NoPose> {
        match self {
            Self::Smooth { smoother, .. } => smoother.at_end(stamp_nanos),
            Self::Straight(straight) => straight.at(stamp_nanos),
        }
    }
}

/// Positions and rotations, each at its own moment.
#[derive(Debug, Clone, Default)]
pub(crate) struct Straight {
    gap_nanos: i64,
    positions: TrajectoryBuffer,
    /// Looked at only when some reading's rotation was older than its position.
    rotations: TrajectoryBuffer,
    lagging: bool,
}

impl Straight {
    fn push(&mut self, reading: &TimedPose, rotation_lag_nanos: i64) -> bool {
        if !self.positions.push(*reading) {
            return false;
        }
        self.lagging |= rotation_lag_nanos != 0;
        // A rotation that is older than the one before it adds nothing; the position stands all the same.
        self.rotations
            .push(TimedPose { stamp_nanos: reading.stamp_nanos.saturating_sub(rotation_lag_nanos), ..*reading });
        true
    }

    fn at(&self, stamp_nanos: i64) -> Result<TimedPose, NoPose> {
        let position = self.positions.at(stamp_nanos, self.gap_nanos)?;
        if !self.lagging {
            return Ok(position);
        }
        let rotation = self.rotations.at(stamp_nanos, self.gap_nanos)?;
        let pose = Isometry3::from_parts(position.pose.translation, rotation.pose.rotation);
        Ok(TimedPose { pose, rotation_sigma_rad: rotation.rotation_sigma_rad, ..position })
    }
}
