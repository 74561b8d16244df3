//! Watches the strokes while the hand moves, so that one that is missing is named while it can still be made.

use crate::evidence::{Notice, Observed};
use crate::finish::CROSSING;
use crate::guard::strokes::{self, Hold, Strokes};
use crate::notices::{holds_little, missing_stroke};
use crate::scene::{FramePose, Problem};
use crate::surfel::Patch;
use crate::testimony::observed;

/// What the strokes were like, look by look.
#[derive(Debug, Clone, Default)]
pub(crate) struct Watch {
    looks: Vec<Look>,
}

#[derive(Debug, Clone, Copy)]
struct Look {
    t_s: f64,
    strokes: Strokes,
    hold: Hold,
}

/// Strokes change slowly: they are looked at from here on, so often.
const EVERY_S: f64 = 5.0;
/// What stays as it was for so long is no accident of the moment ...
const STAYS_S: f64 = 10.0;
/// ... and a hand that crosses its strokes adds more than this to the share on which they cross meanwhile (the demo's: 0.1 at
/// least, from 0.25 after 6 s to 0.7 after 28. One that only goes around: nothing beyond 0.48, which it has after 21 s).
const GROWS: f64 = 0.05;
/// After so long the strokes would have crossed if they were meant to.
const LONG_S: f64 = 30.0;

impl Watch {
    /// Whether it is time to look again.
    pub fn is_due(&self, t_s: f64) -> bool {
        t_s >= self.looks.last().map_or(0.0, |look| look.t_s) + EVERY_S
    }

    /// Looks at what was seen so far.
    pub fn look(&mut self, t_s: f64, problem: &Problem, poses: &[FramePose], patches: &[Patch]) {
        self.looks.push(Look { t_s, strokes: strokes::look(problem, poses, patches), hold: strokes::hold(patches) });
    }

    /// At the last look.
    pub fn observed(&self) -> Option<Observed> {
        self.looks.last().map(|look| observed(&look.strokes, look.hold))
    }

    /// What the operator can still do about what has not become better for a while.
    pub fn advice(&self) -> Vec<Notice> {
        let Some(now) = self.looks.last() else { return Vec::new() };
        let Some(then) = self.looks.iter().rfind(|look| look.t_s <= now.t_s - STAYS_S) else { return Vec::new() };
        let is_late = now.t_s >= LONG_S || now.strokes.crossing < then.strokes.crossing + GROWS;
        let is_missing = is_late && now.strokes.crossing < CROSSING;
        let is_free = now.hold.directions.max(then.hold.directions) < 6;
        let missing = is_missing.then(|| missing_stroke(&now.strokes));
        missing.into_iter().chain(is_free.then(|| holds_little(now.hold))).collect()
    }
}
