//! What one receiver has said, and where it was at a moment.

use geometry::{NoPose, TimedPose, TrajectoryBuffer, rigid_from_wire};
use nalgebra::Isometry3;
use std::collections::VecDeque;
use wire::{Header, Pose, Quality};

/// Why a reading is not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BadReading {
    NotRigid,
    Lag,
    Lost,
    Degraded,
    Backwards,
    Jump,
}

impl BadReading {
    pub fn reason(self) -> &'static str {
        match self {
            Self::NotRigid => "pose that is no rigid transform or has no sigma",
            Self::Lag => "pose whose rotation is more than a second from its position",
            Self::Lost => "pose that the tracker calls lost",
            Self::Degraded => "pose that the tracker calls degraded",
            Self::Backwards => "pose whose time goes backwards",
            Self::Jump => "pose whose time is far ahead of the one before",
        }
    }
}

/// Whether there is more to come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Listening {
    /// It is waited for.
    Live,
    /// It was waited for long enough.
    Silent,
    /// It has said so.
    Ended,
}

/// A reading of which is not decided yet whether it is a moment of the fused poses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Waiting {
    pub header: Header,
    pub usable: bool,
}

/// The readings of one receiver: world_from_receiver.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    pub listening: Listening,
    pub waiting: VecDeque<Waiting>,
    positions: TrajectoryBuffer,
    /// Each at its own moment.
    rotations: TrajectoryBuffer,
    /// Stamps and reasons of those that are degraded.
    degraded: VecDeque<(i64, String)>,
    /// The newest stamp of any reading, usable or not, and the newest moment of a rotation.
    heard: Option<[i64; 2]>,
    /// The last stamp that was far ahead of the one before.
    ahead: Option<i64>,
}

/// A lone stamp so far ahead would shut out all that follow.
const JUMP_NANOS: i64 = 60_000_000_000;
/// No device samples position and rotation farther apart.
const MOST_LAG_NANOS: u64 = 1_000_000_000;
/// No sigma is believed to be smaller: a micrometre, a microradian.
const LEAST_SIGMA: f64 = 1e-6;
/// Beyond ten metres or radians nothing is known.
const MOST_SIGMA: f64 = 10.0;
/// What lies behind is let go in such portions: a buffer moves all that it holds.
const PORTION: usize = 512;

impl Track {
    pub fn new() -> Self {
        Self {
            listening: Listening::Live,
            waiting: VecDeque::new(),
            positions: TrajectoryBuffer::default(),
            rotations: TrajectoryBuffer::default(),
            degraded: VecDeque::new(),
            heard: None,
            ahead: None,
        }
    }

    /// Takes a reading. One that is of no use is heard all the same: nothing earlier will come.
    pub fn take(&mut self, pose: &Pose, use_degraded: bool) -> Result<(), BadReading> {
        let stamp_nanos = pose.header.stamp_nanos;
        self.check_stamp(stamp_nanos)?;
        let lag_nanos = pose.rotation_lag_nanos;
        let measured =
            if lag_nanos.unsigned_abs() > MOST_LAG_NANOS { Err(BadReading::Lag) } else { read(pose, use_degraded) };
        let [_, turned_before] = self.heard.unwrap_or([i64::MIN; 2]);
        self.heard = Some([stamp_nanos, turned_before]);
        self.waiting.push_back(Waiting { header: pose.header, usable: measured.is_ok() });
        let reading = measured?;
        let turned_nanos = stamp_nanos.saturating_sub(lag_nanos);
        self.heard = Some([stamp_nanos, turned_nanos.max(turned_before)]);
        self.positions.push(reading);
        // A rotation that is older than the one before it adds nothing; the position stands all the same.
        self.rotations.push(TimedPose { stamp_nanos: turned_nanos, ..reading });
        if pose.quality == Quality::Degraded {
            self.degraded.push_back((stamp_nanos, pose.reason.clone()));
        }
        Ok(())
    }

    fn check_stamp(&mut self, stamp_nanos: i64) -> Result<(), BadReading> {
        let Some([newest, _]) = self.heard else { return Ok(()) };
        if stamp_nanos <= newest {
            return Err(BadReading::Backwards);
        }
        let near = |earlier: i64| stamp_nanos > earlier && stamp_nanos.saturating_sub(earlier) <= JUMP_NANOS;
        if near(newest) || self.ahead.take().is_some_and(near) {
            self.ahead = None;
            return Ok(());
        }
        self.ahead = Some(stamp_nanos);
        Err(BadReading::Jump)
    }

    /// The newest stamp of any reading.
    pub fn heard(&self) -> Option<i64> {
        self.heard.map(|[stamp_nanos, _]| stamp_nanos)
    }

    /// world_from_receiver at a moment: position and rotation each between its own two readings.
    pub fn at(&self, stamp_nanos: i64, gap_nanos: i64) -> Result<TimedPose, NoPose> {
        let [heard, turned] = self.heard.map_or([None; 2], |heard| heard.map(Some));
        let position = between(&self.positions, stamp_nanos, gap_nanos, heard)?;
        let rotation = between(&self.rotations, stamp_nanos, gap_nanos, turned)?;
        let pose = Isometry3::from_parts(position.pose.translation, rotation.pose.rotation);
        Ok(TimedPose { pose, rotation_sigma_rad: rotation.rotation_sigma_rad, ..position })
    }

    /// Whether what it has yet to say may matter at a moment.
    pub fn is_waited_for(&self, stamp_nanos: i64, gap_nanos: i64) -> bool {
        self.listening == Listening::Live
            && (self.heard().is_none_or(|heard| heard < stamp_nanos)
                || self.at(stamp_nanos, gap_nanos) == Err(NoPose::After))
    }

    /// Why the pose at a moment is not as good as it could be, by the last reading before it.
    pub fn degraded(&self, stamp_nanos: i64, gap_nanos: i64) -> Option<&str> {
        let (at, reason) = self.degraded.iter().rev().find(|(at, _)| *at <= stamp_nanos)?;
        (stamp_nanos.saturating_sub(*at) <= gap_nanos).then_some(reason)
    }

    /// Lets go what no moment behind this one needs.
    pub fn forget_before(&mut self, stamp_nanos: i64) {
        for buffer in [&mut self.positions, &mut self.rotations] {
            let (samples, portion) = (buffer.samples(), PORTION.max(buffer.samples().len() / 2));
            if samples.get(portion).is_some_and(|sample| sample.stamp_nanos <= stamp_nanos) {
                buffer.forget_before(stamp_nanos);
            }
        }
        while self.degraded.get(1).is_some_and(|(at, _)| *at <= stamp_nanos) {
            self.degraded.pop_front();
        }
    }
}

fn read(pose: &Pose, use_degraded: bool) -> Result<TimedPose, BadReading> {
    match pose.quality {
        Quality::Lost => return Err(BadReading::Lost),
        Quality::Degraded if !use_degraded => return Err(BadReading::Degraded),
        _ => {}
    }
    // The largest of the three axes, as all who read poses take it.
    let sigma = |axes: [f64; 3]| {
        let good = axes.iter().all(|sigma| (0.0..=MOST_SIGMA).contains(sigma));
        good.then(|| axes.into_iter().fold(LEAST_SIGMA, f64::max)).ok_or(BadReading::NotRigid)
    };
    Ok(TimedPose {
        stamp_nanos: pose.header.stamp_nanos,
        pose: rigid_from_wire(&pose.world_from_body).ok_or(BadReading::NotRigid)?,
        position_sigma_m: sigma(pose.position_sigma_m)?,
        rotation_sigma_rad: sigma(pose.rotation_sigma_rad)?,
    })
}

/// As the buffer has it; but what comes later is not waited for when it comes too late to be of use.
fn between(
    buffer: &TrajectoryBuffer,
    stamp_nanos: i64,
    gap_nanos: i64,
    heard: Option<i64>,
) -> Result<TimedPose, NoPose> {
    let pose = buffer.at(stamp_nanos, gap_nanos);
    let (Err(NoPose::After), Some(heard)) = (pose, heard) else { return pose };
    match buffer.samples().last() {
        None if heard >= stamp_nanos => Err(NoPose::Before),
        Some(last) if heard.saturating_sub(last.stamp_nanos) > gap_nanos => Err(NoPose::Gap),
        _ => Err(NoPose::After),
    }
}
