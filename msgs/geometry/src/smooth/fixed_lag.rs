//! The smooth way while the readings still come.

use super::answer::{Fitted, Moment, Tuning, between, judged};
use super::part::{Part, WINDOW_NANOS, around};
use super::readings::{is_finite, positions, rotations, turn};
use super::track::Track;
use super::{SmoothError, Smoothing};
use crate::{NoPose, TimedPose};

/// How far behind the newest reading a pose is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wait {
    /// The answer waits for a reading so long behind the moment: 0 is the newest edge, where the pose is least sure.
    pub lag_nanos: i64,
    /// The answer may come from readings up to so long before that, when they tell the pose better than the reading that
    /// is waited for would alone.
    pub predict_nanos: i64,
}

/// Takes readings one by one, and tells the smooth pose at moments near the newest.
///
/// What it answers is a function of the readings' stamps alone: the answer is computed from the readings up to the first
/// one that allows it, whether more are there already or not. So batches, replays and late starts give the same bytes.
#[derive(Debug, Clone)]
pub struct FixedLagSmoother {
    config: Smoothing,
    readings: Vec<Reading>,
    newest_rotation_nanos: Option<i64>,
    tunings: Vec<Tuning>,
    taken: u64,
}

#[derive(Debug, Clone, Copy)]
struct Reading {
    pose: TimedPose,
    /// When the rotation was sampled; `None` when that was not later than the one before.
    rotation_nanos: Option<i64>,
}

/// Both are chosen anew from the readings of so long...
const TUNING_NANOS: i64 = 4_000_000_000;
/// ... so often,
const TUNE_EVERY_NANOS: i64 = 500_000_000;
/// and at these counts of readings, so that the first frames are smooth too.
const FIRST_TUNINGS: [u64; 4] = [16, 32, 64, 128];
/// Moments of one such time are answered together.
const SETTLE_NANOS: i64 = 50_000_000;
impl FixedLagSmoother {
    /// Without readings.
    pub fn new(config: Smoothing) -> Result<Self, SmoothError> {
        config.check()?;
        Ok(Self { config, readings: Vec::new(), newest_rotation_nanos: None, tunings: Vec::new(), taken: 0 })
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.readings.clear();
        self.newest_rotation_nanos = None;
        self.tunings.clear();
        self.taken = 0;
    }

    /// Takes a reading whose rotation was sampled so long before its position; refuses one that is not finite or not
    /// later than the last (`false`).
    pub fn push(&mut self, reading: &TimedPose, rotation_lag_nanos: i64) -> bool {
        let stamp_nanos = reading.stamp_nanos;
        let last = self.readings.last().copied();
        if !is_finite(reading) || last.is_some_and(|last| stamp_nanos <= last.pose.stamp_nanos) {
            return false;
        }
        let turned = stamp_nanos.saturating_sub(rotation_lag_nanos);
        let rotation_nanos = self.newest_rotation_nanos.is_none_or(|newest| turned > newest).then_some(turned);
        self.newest_rotation_nanos = rotation_nanos.or(self.newest_rotation_nanos);
        self.readings.push(Reading { pose: *reading, rotation_nanos });
        self.taken += 1;
        let period = |stamp_nanos: i64| stamp_nanos.div_euclid(TUNE_EVERY_NANOS);
        let crossed = last.is_some_and(|last| period(last.pose.stamp_nanos) != period(stamp_nanos));
        if self.taken > FIRST_TUNINGS[0] && crossed || FIRST_TUNINGS.contains(&self.taken) {
            self.tune();
        }
        true
    }

    fn tune(&mut self) {
        let Some(stamp_nanos) = self.newest() else { return };
        let from = stamp_nanos.saturating_sub(TUNING_NANOS);
        let first = self.readings.partition_point(|r| r.pose.stamp_nanos < from);
        let (position, rotation) = self.rows(first, self.readings.len());
        let position = Track::fit(positions(&position), &self.config, |_, off| *off);
        let rotation = Track::fit(rotations(&rotation), &self.config, turn);
        if let (Some(position), Some(rotation)) = (position, rotation) {
            let (position, rotation) = (Part::tuned(&position), Part::tuned(&rotation));
            self.tunings.push(Tuning { stamp_nanos, position, rotation });
        }
    }

    /// The stamp of the newest reading.
    pub fn newest(&self) -> Option<i64> {
        self.readings.last().map(|r| r.pose.stamp_nanos)
    }

    /// The stamp of the oldest reading that is kept.
    pub fn oldest(&self) -> Option<i64> {
        self.readings.first().map(|r| r.pose.stamp_nanos)
    }

    /// Forgets what no pose at or behind a moment needs.
    pub fn forget_before(&mut self, stamp_nanos: i64) {
        let from = stamp_nanos.saturating_sub(TUNING_NANOS + WINDOW_NANOS);
        let first = self.readings.partition_point(|r| r.pose.stamp_nanos < from).saturating_sub(1);
        self.readings.drain(..first);
        self.tunings.drain(..self.tunings.partition_point(|t| t.stamp_nanos < from).saturating_sub(1));
    }

    /// The pose at a moment. Its sigmas are those of the white noise that is left, together with what the tracker states
    /// beyond its white noise. [`NoPose::After`]: more readings are needed.
    pub fn at(&self, stamp_nanos: i64, wait: &Wait) -> Result<TimedPose, NoPose> {
        let until = stamp_nanos.saturating_add(wait.lag_nanos);
        let from = until.saturating_sub(wait.predict_nanos);
        for last in self.readings.partition_point(|r| r.pose.stamp_nanos < from)..self.readings.len() {
            let reading = &self.readings[last];
            let turned = reading.rotation_nanos.is_some_and(|turned| turned >= until);
            if reading.pose.stamp_nanos >= until && turned {
                return self.answer(stamp_nanos, last + 1, Moment::Due);
            }
            // No attempts without end when rotations have stopped coming.
            if reading.pose.stamp_nanos <= until.saturating_add(WINDOW_NANOS) {
                match self.answer(stamp_nanos, last + 1, Moment::Early) {
                    Err(NoPose::After) => {}
                    early => return early,
                }
            }
        }
        Err(NoPose::After)
    }

    /// The pose at a moment when no more readings will come.
    pub fn at_end(&self, stamp_nanos: i64) -> Result<TimedPose, NoPose> {
        if self.newest().is_none_or(|newest| newest < stamp_nanos) {
            return Err(NoPose::After);
        }
        self.answer(stamp_nanos, self.readings.len(), Moment::Due)
    }

    /// The poses at the first of some moments in order, those that lie in one twentieth of a second: one fit serves them
    /// all. It is made from the readings up to the first one that is `lag_nanos` behind that time; before it has come:
    /// [`NoPose::After`].
    pub fn settled(&self, moments: &[i64], lag_nanos: i64) -> Result<Vec<Result<TimedPose, NoPose>>, NoPose> {
        let period = |stamp_nanos: i64| stamp_nanos.div_euclid(SETTLE_NANOS);
        let Some(&first) = moments.first() else { return Ok(Vec::new()) };
        let moments = &moments[..moments.partition_point(|&moment| period(moment) <= period(first))];
        let begins = period(first).saturating_mul(SETTLE_NANOS);
        let ends = begins.saturating_add(SETTLE_NANOS);
        let until = ends.saturating_add(lag_nanos);
        let has_come = |r: &Reading| r.pose.stamp_nanos >= until && r.rotation_nanos.is_some_and(|at| at >= until);
        let behind = self.readings.partition_point(|r| r.pose.stamp_nanos < until);
        let last = behind + self.readings[behind..].iter().position(has_come).ok_or(NoPose::After)?;
        let (position, rotation) = self.around(begins, last + 1);
        let fitted = self.fit(&position, &rotation, ends);
        let at = |&moment: &i64| {
            let straight = between(&position, &rotation, moment, self.config.most_gap_nanos());
            judged(straight, || fitted.as_ref()?.at(moment), Moment::Due)
        };
        Ok(moments.iter().map(at).collect())
    }

    /// From the readings before index `end`.
    fn answer(&self, stamp_nanos: i64, end: usize, moment: Moment) -> Result<TimedPose, NoPose> {
        let (position, rotation) = self.around(stamp_nanos, end);
        let straight = between(&position, &rotation, stamp_nanos, self.config.most_gap_nanos());
        judged(straight, || self.fit(&position, &rotation, stamp_nanos)?.at(stamp_nanos), moment)
    }

    /// `None` before anything is known of the noise, or when the readings are too few.
    fn fit(&self, position: &[TimedPose], rotation: &[TimedPose], last_nanos: i64) -> Option<Fitted> {
        let newest = *position.last()?;
        let known = self.tunings.partition_point(|t| t.stamp_nanos <= newest.stamp_nanos);
        let tuning = *self.tunings.get(known.checked_sub(1)?)?;
        let position = tuning.position.fit(around(positions(position), last_nanos), last_nanos, &self.config)?;
        let rotation = tuning.rotation.fit(around(rotations(rotation), last_nanos), last_nanos, &self.config)?;
        Some(Fitted { tuning, position, rotation, newest })
    }

    /// The readings that tell of a moment, up to index `end`.
    fn around(&self, stamp_nanos: i64, end: usize) -> (Vec<TimedPose>, Vec<TimedPose>) {
        let from = stamp_nanos.saturating_sub(WINDOW_NANOS);
        // One more, so that a silence before the moment is seen as one.
        let first = self.readings.partition_point(|r| r.pose.stamp_nanos < from).saturating_sub(1).min(end);
        self.rows(first, end)
    }

    /// Positions and rotations of some readings, each with its own stamp.
    fn rows(&self, first: usize, end: usize) -> (Vec<TimedPose>, Vec<TimedPose>) {
        let readings = &self.readings[first..end];
        let turned = |r: &Reading| r.rotation_nanos.map(|stamp_nanos| TimedPose { stamp_nanos, ..r.pose });
        (readings.iter().map(|r| r.pose).collect(), readings.iter().filter_map(turned).collect())
    }
}
