//! One global step on everything so far, again and again while the scan goes on.
//!
//! All frames stay free (a window of free frames on a frozen map drifts along a stroke and bakes its error in). What was
//! found by the tick before is where the next begins; new time begins at the smoothed tracker. Points and surfels are
//! bounded; the smoothing, the unknowns of the frames and their sigmas are not, and grow with the scan.

use crate::Config;
use crate::evidence::{Evidence, Notice, Residual};
use crate::gather::Gathered;
use crate::judge::judge;
use crate::outcome::outcome;
use crate::prior::Prior;
use crate::refinement::Refinement;
use crate::scene::Problem;
use crate::schedule::{LIVE, judging_live};
use crate::solver::{self, Noise};
use crate::spline::Knots;
use crate::step::{StepPlan, step};
use crate::testimony::{clock, hand_eye_held, refused, tracker};
use crate::tracker::Smoothed;
use crate::unknowns::{BIAS, Free, GLOBALS, SPLINES, Unknowns};
use crate::watch::Watch;
use geometry::{Smoothing, word};
use nalgebra::{Isometry3, Vector3};

/// What goes on from tick to tick.
#[derive(Debug, Clone, Default)]
pub(crate) struct Live {
    ticks: u64,
    x: Vec<f64>,
    unknowns: Option<Unknowns>,
    /// Of each level.
    scale_m: [Option<f64>; LIVE.len()],
    /// The middle of the first tick: the field's polynomial stays centred there.
    origin: Option<Vector3<f64>>,
    watch: Watch,
}

/// Before so much time, strokes have hardly met.
const FIRST_S: f64 = 2.0;
/// Before this the field and the clock are not told from the slow correction.
const GLOBALS_S: f64 = 10.0;
/// In a live scan the readings are believed less, because the kind of their noise is not known yet.
const INFLATION: f64 = 3.0;

/// One tick. `None` while there is too little to refine.
pub(crate) fn tick(
    config: &Config,
    gathered: &Gathered,
    body_from_camera: Isometry3<f64>,
    live: &mut Live,
) -> Option<Refinement> {
    let smoothing = Smoothing { most_gap_ms: config.most_gap_ms, ..Smoothing::default() };
    let smoothed = Smoothed::new(gathered, &smoothing).ok()?;
    let frames = solver::place(gathered, &smoothed);
    if frames.last()?.t_s - frames.first()?.t_s < FIRST_S {
        return None;
    }
    let noise = Noise { inflation: INFLATION, ..Noise::white(config) };
    let mut problem = solver::problem(config, &noise, gathered, &smoothed, &frames, body_from_camera);
    problem.origin = *live.origin.get_or_insert(problem.origin);
    let mut x = live.go_on(&problem.unknowns);
    let prior = solver::prior(config, &noise, &problem);
    let late = frames.last()?.t_s > GLOBALS_S;
    let free = Free { splines: [true; SPLINES], field: late, clock: late, lag: false, hand_eye: false };
    let taken_back = live.steps(config, &problem, &prior, free, &mut x);
    let plan = judging_live(config.seed);
    let zeros = vec![0.0; x.len()];
    let before = judge(&problem, &problem.poses(&zeros), &plan);
    let after = judge(&problem, &problem.poses(&x), &plan);
    let better = after.sigma_m <= before.sigma_m;
    let (used, judged) = if better { (&x, &after) } else { (&zeros, &before) };
    let t_s = frames.last()?.t_s;
    if live.watch.is_due(t_s) {
        live.watch.look(t_s, &problem, &problem.poses(used), &judged.seen.patches);
    }
    let notices = [(!better, Notice::KeptSmoothed), (taken_back, Notice::StepTakenBack)];
    let notices = notices.into_iter().filter(|(noticed, _)| *noticed).map(|(_, notice)| notice);
    let notices = live.watch.advice().into_iter().chain(notices).collect();
    let out = outcome(config, &problem, &prior, judged, &[], used);
    let evidence = Evidence {
        residual: Residual { before_mm: before.sigma_m * 1e3, after_mm: judged.sigma_m * 1e3 },
        tracker: tracker(&smoothed, None, noise),
        clock: clock(&problem, used, [f64::NAN; 2]),
        hand_eye: hand_eye_held(config),
        observed: live.watch.observed(),
        notices,
        frames_kept: out.frames.len(),
        dropped: out.dropped,
        frames_without_pose: gathered.frames.len() - frames.len(),
        refused: refused(gathered),
        seen_through: 0,
        frames_on_table: 0,
        frames: out.kept,
    };
    live.unknowns = Some(problem.unknowns);
    // Steps that made things worse are forgotten, or the next would begin there.
    live.x = if better { x } else { zeros };
    Some(Refinement { trajectory: out.trajectory, evidence, frames: out.frames })
}

impl Live {
    /// One step on each level. True when one was not finite and was taken back.
    fn steps(&mut self, config: &Config, problem: &Problem, prior: &Prior, free: Free, x: &mut Vec<f64>) -> bool {
        let mut taken_back = false;
        for (level, stage) in LIVE.iter().enumerate() {
            let seed = word(config.seed, self.ticks * LIVE.len() as u64 + level as u64);
            let scale_m = self.scale_m[level].unwrap_or(f64::INFINITY);
            let before = x.clone();
            let plan = StepPlan { table: config.flat_table, ..stage.plan(free, scale_m, seed) };
            match step(problem, prior, &plan, x) {
                Some(seen) => self.scale_m[level] = Some(2.0 * seen.sigma_m),
                None => (*x, taken_back) = (before, true),
            }
        }
        self.ticks += 1;
        taken_back
    }

    /// The unknowns of the tick before, laid out for more time. New knots of the fast corrections are 0; the slow
    /// one goes on as it was.
    fn go_on(&self, unknowns: &Unknowns) -> Vec<f64> {
        let mut x = vec![0.0; unknowns.len()];
        let Some(before) = &self.unknowns else { return x };
        let same = |a: &Knots, b: &Knots| a.start_s == b.start_s && a.step_s == b.step_s && a.count <= b.count;
        if !before.splines.iter().zip(&unknowns.splines).all(|(a, b)| same(a, b)) {
            return x;
        }
        for which in 0..SPLINES {
            let (known, start) = (before.spline(which), unknowns.spline(which).start);
            x[start..start + known.len()].copy_from_slice(&self.x[known]);
        }
        let (bias, known) = (unknowns.spline(BIAS), before.spline(BIAS));
        let last = &self.x[known.end - 6..known.end];
        x[bias.start + known.len()..bias.end].chunks_exact_mut(6).for_each(|knot| knot.copy_from_slice(last));
        let globals = unknowns.globals();
        x[globals.clone()].copy_from_slice(&self.x[before.globals()]);
        debug_assert_eq!(globals.len(), GLOBALS);
        x
    }
}
