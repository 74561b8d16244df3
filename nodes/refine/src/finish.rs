//! The full schedule, and all that guards it.

use crate::evidence::{Evidence, Notice, Observed, Residual};
use crate::gather::Gathered;
use crate::guard::strokes;
use crate::judge::{Judgement, judge};
use crate::notices::{missing_stroke, notice_solution, notice_surface};
use crate::outcome::outcome;
use crate::posterior::{ONE_SURFEL_IN, region_sigmas_m};
use crate::prior::Prior;
use crate::refinement::Refinement;
use crate::scene::{Placed, Problem};
use crate::schedule::{judging, wide};
use crate::seen_through::carve;
use crate::solver::{self, Noise, Solution};
use crate::step::look;
use crate::system::System;
use crate::testimony::{globals, refused, tracker};
use crate::tracker::Smoothed;
use crate::unknowns::{Free, SPLINES};
use crate::{Config, RefineError};
use geometry::Smoothing;
use nalgebra::Isometry3;

/// Stripes must cross on this share of the surface before the hand-eye transform is freed. (A hand that only goes around the
/// thing rolls a little all the same: 0.5. One that crosses its strokes: 0.75 and more.)
pub(crate) const CROSSING: f64 = 0.6;
/// Less of the memberships seen by other strokes is nothing.
const SEEN_TWICE: f64 = 0.05;
/// The hand-eye correction may leave what is believed by so many standard deviations.
const RAN_AWAY: f64 = 4.0;

/// Refines what was gathered.
pub(crate) fn finish(
    config: &Config,
    gathered: &Gathered,
    body_from_camera: Isometry3<f64>,
) -> Result<Refinement, RefineError> {
    let smoothing = Smoothing { most_gap_ms: config.most_gap_ms, ..Smoothing::default() };
    let smoothed = Smoothed::new(gathered, &smoothing)?;
    let frames = solver::place(gathered, &smoothed);
    if frames.is_empty() {
        return Err(RefineError::NoFrames { frames: gathered.frames.len() });
    }
    let noise = Noise::white(config);
    let still = solver::problem(config, &noise, gathered, &smoothed, &frames, body_from_camera);
    let zeros = vec![0.0; still.unknowns.len()];
    let poses = still.poses(&zeros);
    let before = judge(&still, &poses, &judging(config.seed));
    let wide_before = look(&still, &poses, &wide(config.seed));
    let strokes = strokes::look(&still, &poses, &wide_before.patches);
    let mut notices = Vec::new();
    let free = Free {
        splines: [true; SPLINES],
        field: true,
        clock: true,
        lag: config.rotation_lag_ms > 0.0,
        hand_eye: strokes.crossing >= CROSSING,
    };
    if !free.hand_eye {
        notices.push(missing_stroke(&strokes));
    }
    let (problem, solution) = solve(config, free, gathered, &smoothed, &frames, body_from_camera, &mut notices);
    let poses = problem.poses(&solution.x);
    let after = judge(&problem, &poses, &judging(config.seed));
    let wide_after = look(&problem, &poses, &wide(config.seed));
    let held = strokes::hold(&wide_after.patches);
    notice_solution(&solution, &mut notices);
    notice_surface(&problem, &solution, held, &mut notices);
    let kept = keep_better(&before, &after, &mut notices);
    let (problem, x, judged, noise) =
        if kept { (&problem, &solution.x, &after, solution.noise) } else { (&still, &zeros, &before, noise) };
    let prior = solver::prior(config, &noise, problem);
    let regions = regions_sigma_m(config, problem, &prior, judged, solution.free, kept, x);
    let mut out = outcome(config, problem, &prior, judged, &regions, x);
    let carved = carve(&mut out.frames);
    let (clock, hand_eye) = globals(problem, &prior, &wide_after.thinned(ONE_SURFEL_IN, config.seed), solution.free, x);
    let observed =
        Observed { crossing: strokes.crossing, stripes_along: strokes.along.into(), held_directions: held.directions };
    let evidence = Evidence {
        residual: Residual { before_mm: before.sigma_m * 1e3, after_mm: judged.sigma_m * 1e3 },
        tracker: tracker(&smoothed, solution.excess, noise),
        clock,
        hand_eye,
        observed: Some(observed),
        notices,
        frames_kept: out.frames.len(),
        dropped: out.dropped,
        frames_without_pose: gathered.frames.len() - frames.len(),
        refused: refused(gathered),
        seen_through: carved,
        frames_on_table: solution.frames_on_table,
        frames: out.kept,
    };
    Ok(Refinement { trajectory: out.trajectory, evidence, frames: out.frames })
}

/// See [`region_sigmas_m`]; where the refined way is not given out, of the smoothed one.
fn regions_sigma_m(
    config: &Config,
    problem: &Problem,
    prior: &Prior,
    judged: &Judgement,
    free: Free,
    kept: bool,
    x: &[f64],
) -> Vec<f64> {
    let poses = problem.poses(x);
    // What was held fast is not known the better for it.
    let unknown = Free { hand_eye: true, clock: true, ..free };
    let few = judged.seen.thinned(ONE_SURFEL_IN, config.seed);
    let information_m2 = judged.information_m2 * few.weight / judged.seen.weight;
    let few = if kept { few } else { few.unheard() };
    let system = System::new(problem, prior, &few, &unknown, &poses);
    region_sigmas_m(&system, information_m2, solver::cg_steps(problem), config.seed)
}

/// Whether the refined way is given out: it must fit better, and something must have been seen twice.
fn keep_better(before: &Judgement, after: &Judgement, notices: &mut Vec<Notice>) -> bool {
    if after.seen_twice < SEEN_TWICE {
        notices.insert(0, Notice::NothingSeenTwice);
        return false;
    }
    let better = after.sigma_m <= before.sigma_m;
    if !better {
        notices.insert(0, Notice::KeptSmoothed);
    }
    better
}

/// The schedule; once more with the hand-eye transform held when it ran away.
fn solve<'a>(
    config: &Config,
    free: Free,
    gathered: &'a Gathered,
    smoothed: &'a Smoothed,
    frames: &'a [Placed],
    body_from_camera: Isometry3<f64>,
    notices: &mut Vec<Notice>,
) -> (Problem<'a>, Solution) {
    let (problem, solution) = solver::run(config, free, gathered, smoothed, frames, body_from_camera);
    let eta = &solution.x[problem.unknowns.hand_eye()];
    let beliefs = [config.hand_eye_mm * 1e-3, config.hand_eye_deg.to_radians()];
    if (0..6).all(|i| eta[i].abs() <= RAN_AWAY * beliefs[i / 3]) {
        return (problem, solution);
    }
    notices.push(Notice::HandEyeRanAway {
        shift_mm: [0, 1, 2].map(|i| eta[i] * 1e3),
        turn_deg: [3, 4, 5].map(|i| eta[i].to_degrees()),
    });
    solver::run(config, Free { hand_eye: false, ..free }, gathered, smoothed, frames, body_from_camera)
}
