//! The tracker's readings on the camera's clock.

use crate::Config;
use crate::between::Between;
use geometry::{NoPose, SmoothError, TimedPose, rigid_from_wire};
use std::collections::VecDeque;
use wire::{Pose, Quality};

/// Why a reading is not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum BadReading {
    NotFinite,
    Lost,
    Degraded,
    Backwards,
    Jump,
}

impl BadReading {
    pub(crate) fn reason(self) -> &'static str {
        match self {
            Self::NotFinite => "pose that is no rigid transform",
            Self::Lost => "pose that the tracker calls lost",
            Self::Degraded => "pose that the tracker calls degraded",
            Self::Backwards => "pose whose time goes backwards",
            Self::Jump => "pose whose time is far from the one before",
        }
    }
}

/// What the tracker said, `world_from_body`.
#[derive(Debug, Clone)]
pub(crate) struct Readings {
    between: Between,
    use_degraded: bool,
    /// Moments of readings that are not told yet as a part of the way.
    untold: VecDeque<i64>,
    /// The last stamp that was far from its neighbours.
    suspect: Option<i64>,
}

/// Readings are kept so long behind the newest, so that a node that starts in mid-scan can take all poses before the
/// first profile.
pub(crate) const KEPT_NANOS: i64 = 600_000_000_000;
/// A single reading so far from the one before is no reading; two in a row are a clock that was set.
const JUMP_NANOS: u64 = 60_000_000_000;

impl Readings {
    pub(crate) fn new(config: &Config) -> Result<Self, SmoothError> {
        let between = Between::new(config)?;
        Ok(Self { between, use_degraded: config.use_degraded, untold: VecDeque::new(), suspect: None })
    }

    /// Takes a reading.
    pub(crate) fn take(&mut self, pose: &Pose, offset_nanos: i64) -> Result<(), BadReading> {
        match pose.quality {
            Quality::Lost => return Err(BadReading::Lost),
            Quality::Degraded if !self.use_degraded => return Err(BadReading::Degraded),
            _ => {}
        }
        let world_from_body = rigid_from_wire(&pose.world_from_body).ok_or(BadReading::NotFinite)?;
        let sigma = |axes: [f64; 3]| {
            let good = axes.iter().all(|sigma| sigma.is_finite() && *sigma >= 0.0);
            good.then(|| axes.iter().copied().fold(0.0, f64::max)).ok_or(BadReading::NotFinite)
        };
        let reading = TimedPose {
            stamp_nanos: pose.header.stamp_nanos.saturating_add(offset_nanos),
            pose: world_from_body,
            position_sigma_m: sigma(pose.position_sigma_m)?,
            rotation_sigma_rad: sigma(pose.rotation_sigma_rad)?,
        };
        self.check_clock(reading.stamp_nanos)?;
        if !self.between.push(&reading, pose.rotation_lag_nanos) {
            return Err(BadReading::Backwards);
        }
        self.untold.push_back(reading.stamp_nanos);
        self.forget();
        Ok(())
    }

    /// Refuses a lone stamp far from the last; of two that follow one another the second is believed.
    fn check_clock(&mut self, stamp_nanos: i64) -> Result<(), BadReading> {
        let Some(newest) = self.newest() else { return Ok(()) };
        if stamp_nanos.abs_diff(newest) <= JUMP_NANOS {
            self.suspect = None;
            return Ok(());
        }
        let follows = |suspect: i64| stamp_nanos > suspect && stamp_nanos.abs_diff(suspect) <= JUMP_NANOS;
        let believed = self.suspect.is_some_and(follows);
        self.suspect = Some(stamp_nanos);
        if !believed {
            return Err(BadReading::Jump);
        }
        if stamp_nanos < newest {
            self.between.clear();
            self.untold.clear();
        }
        Ok(())
    }

    /// Drops what is too old, but not at every reading: a buffer moves all it holds.
    fn forget(&mut self) {
        let Some((first, newest)) = self.between.span() else { return };
        let oldest = newest.saturating_sub(KEPT_NANOS);
        if first < oldest.saturating_sub(KEPT_NANOS / 4) {
            self.between.forget_before(oldest);
            self.untold.retain(|stamp_nanos| *stamp_nanos >= oldest);
        }
    }

    /// The stamp of the last reading, on the camera's clock.
    pub(crate) fn newest(&self) -> Option<i64> {
        self.between.span().map(|(_, newest)| newest)
    }

    /// world_from_body at a moment of the camera's clock, as soon as it is known well enough.
    pub(crate) fn at(&self, stamp_nanos: i64) -> Result<TimedPose, NoPose> {
        self.between.at(stamp_nanos)
    }

    /// The same when no reading will come any more.
    pub(crate) fn at_end(&self, stamp_nanos: i64) -> Result<TimedPose, NoPose> {
        self.between.at_end(stamp_nanos)
    }

    /// world_from_body at the readings since the last call, as far as it is known by now; the rest too when no reading
    /// will come any more.
    pub(crate) fn tell(&mut self, ended: bool) -> Vec<TimedPose> {
        let mut way = Vec::new();
        while let Some(&next) = self.untold.front() {
            // No rotation was measured around it: the way has no sample there.
            let settled = match self.between.settled(self.untold.make_contiguous()) {
                Err(_) if !ended => break,
                Err(_) => vec![self.between.at_end(next)],
                Ok(settled) => settled,
            };
            self.untold.drain(..settled.len());
            way.extend(settled.into_iter().flatten());
        }
        way
    }
}
