//! How well the frames fit together at given poses, and how well each pose is known.

use crate::banded::Banded;
use crate::precondition::spline_block;
use crate::prior::Prior;
use crate::scene::{FramePose, Problem};
use crate::schur::FrameData;
use crate::step::{Seen, StepPlan, look};
use crate::surfel::Member;
use crate::unknowns::{Row, SPLINES};
use nalgebra::{Matrix6, Vector6};
use rayon::prelude::*;

/// One frame, judged.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrameJudgement {
    /// Four in five of its points are closer to the surface that all frames give; metres. NaN without members. (Of a frame
    /// that is turned away, half of the points may fit.)
    pub residual_m: f64,
    /// Memberships in surfels.
    pub members: u32,
    /// How much of it lies on surface that other strokes saw, about 0 to 1: memberships in such surfels, over what so many
    /// points have on average.
    pub held: f64,
    /// The mean of J J^T over its members, J being d distance / d correction.
    pub across: Matrix6<f64>,
    /// What the other strokes tell of this frame's correction.
    pub information: Matrix6<f64>,
}

/// All frames, judged.
pub(crate) struct Judgement {
    pub frames: Vec<FrameJudgement>,
    /// 1.4826 median |e| of all.
    pub sigma_m: f64,
    /// The share of memberships in surfels that other strokes saw as well.
    pub seen_twice: f64,
    /// What was looked at.
    pub seen: Seen,
    /// One over the variance that a membership would have if each were a witness of its own, in 1/m^2: neighbours tell the
    /// same, and a point is a member of several surfels.
    pub information_m2: f64,
}

/// So many neighbours err alike: speckle, the borders of colours and the edges of the lit line reach over several points of a
/// stripe. Without it the model's error was half as large again as stated (`limn demo`, the row "as its own sigma says").
const ALIKE: f64 = 4.0;
/// Frames nearer in time than this move together: a surfel that only they saw says nothing of where they are.
const STROKE_S: f64 = 0.5;

/// Looks at the poses once, without moving anything.
pub(crate) fn judge(problem: &Problem, poses: &[FramePose], plan: &StepPlan) -> Judgement {
    let seen = look(problem, poses, plan);
    let sigma_m = seen.sigma_m.max(1e-6);
    let mut residuals: Vec<Vec<f32>> = vec![Vec::new(); poses.len()];
    let mut information = vec![Matrix6::zeros(); poses.len()];
    let mut across = vec![Matrix6::zeros(); poses.len()];
    let mut twice = vec![0usize; poses.len()];
    let (mut weights, mut used) = (0.0, 0usize);
    for members in seen.patches.iter().flat_map(|patch| patch.surfels()) {
        for member in members {
            residuals[member.frame as usize].push(member.distance_m.abs());
            let weight = f64::from(member.root_weight).powi(2);
            weights += weight;
            used += 1;
            let jacobian = Vector6::from_fn(|i, _| f64::from(member.jacobian[i]));
            across[member.frame as usize].ger(1.0 / weight.max(1e-12), &jacobian, &jacobian, 1.0);
            let others = others_share(problem, members, member);
            twice[member.frame as usize] += usize::from(others > 0.1);
            information[member.frame as usize].ger(others, &jacobian, &jacobian, 1.0);
        }
    }
    // Each point counts once, however many surfels it belongs to; and neighbours tell the same.
    let points: usize = seen.sampled.min(used);
    let once = points as f64 / f64::max(weights, 1.0) / (sigma_m * sigma_m) / ALIKE;
    let usual = used as f64 / seen.sampled.max(1) as f64;
    let frame = |k: usize| {
        let points = problem.gathered.frames[problem.frames[k].frame].points.len() as f64;
        FrameJudgement {
            residual_m: upper(&residuals[k]),
            members: seen.frames[k].members,
            held: twice[k] as f64 / (points * seen.share * usual).max(1.0),
            across: across[k] / f64::from(seen.frames[k].members.max(1)),
            information: information[k] * once,
        }
    };
    let frames: Vec<FrameJudgement> = (0..poses.len()).map(frame).collect();
    let seen_twice = twice.iter().sum::<usize>() as f64 / used.max(1) as f64;
    Judgement { frames, sigma_m, seen_twice, seen, information_m2: once }
}

/// The share of a surfel that frames of other strokes hold: two groups of weights a and b tell of their offset as much
/// as a b / (a + b), which is a times this.
fn others_share(problem: &Problem, members: &[Member], own: &Member) -> f64 {
    let t_s = problem.frames[own.frame as usize].t_s;
    let (mut others, mut all) = (0.0, 0.0);
    for member in members {
        let weight = f64::from(member.root_weight).powi(2);
        all += weight;
        if (problem.frames[member.frame as usize].t_s - t_s).abs() > STROKE_S {
            others += weight;
        }
    }
    if all > 0.0 { others / all } else { 0.0 }
}

fn upper(sizes: &[f32]) -> f64 {
    let mut sizes = sizes.to_vec();
    if sizes.is_empty() {
        return f64::NAN;
    }
    let place = sizes.len() * 4 / 5;
    f64::from(*sizes.select_nth_unstable_by(place, f32::total_cmp).1)
}

/// The covariance of each frame's correction: what the data leave of the fast and of the slow one, added as if they
/// were independent (the field, hand-eye and clock are held by all frames and are left out).
pub(crate) fn covariances(problem: &Problem, rows: &[&Row], judgement: &Judgement, prior: &Prior) -> Vec<Matrix6<f64>> {
    let data: Vec<FrameData> = judgement
        .frames
        .iter()
        .map(|frame| FrameData { hessian: frame.information, force: Vector6::zeros(), members: frame.members })
        .collect();
    let inverse = |which: usize| spline_block(&problem.unknowns, which, rows, &data, prior).factor().inverse_band();
    let inverses: Vec<Banded> = (0..SPLINES).into_par_iter().map(inverse).collect();
    let at = |row: &&Row| inverses.iter().zip(&row.knots).map(|(inverse, knots)| at_frame(inverse, knots)).sum();
    rows.iter().map(at).collect()
}

/// The covariance of a spline's value, from that of its control points.
fn at_frame(inverse: &Banded, (first, weights): &(usize, [f64; 4])) -> Matrix6<f64> {
    let mut sum = Matrix6::zeros();
    for a in 0..4 {
        for b in 0..4 {
            let weight = weights[a] * weights[b];
            for i in 0..6 {
                for j in 0..6 {
                    let (row, column) = (6 * (first + a) + i, 6 * (first + b) + j);
                    sum[(i, j)] += weight * inverse.at(row.max(column), row.min(column));
                }
            }
        }
    }
    sum
}
