//! One Gauss-Newton step: surfels at the present poses, and the correction that brings their points together.

use crate::cloud::Cloud;
use crate::pcg;
use crate::precondition::Preconditioner;
use crate::prior::Prior;
use crate::scene::{FramePose, Problem};
use crate::schur::{FRAMES_A_TASK, FrameData, Room, frame_data, product, robust_sigma_m};
use crate::surfel::{Patch, SurfelPlan, build};
use crate::table;
use crate::unknowns::{Free, Row};
use nalgebra::Vector6;
use rayon::prelude::*;

/// What a step works with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct StepPlan {
    pub surfels: SurfelPlan,
    /// About so many points are looked at.
    pub points: usize,
    /// Bounds of the robust scale.
    pub scale_m: [f64; 2],
    pub free: Free,
    /// Whether a flat table is looked for.
    pub table: bool,
    pub cg_steps: usize,
    pub seed: u64,
}

/// The data at one set of poses.
pub(crate) struct Seen {
    pub patches: Vec<Patch>,
    pub frames: Vec<FrameData>,
    /// 1.4826 median |e|.
    pub sigma_m: f64,
    /// The data's common weight.
    pub weight: f64,
    /// How many points were looked at.
    pub sampled: usize,
    /// And what share of all that is.
    pub share: f64,
    /// Frames that saw a flat table; 0 where none was looked for, or found.
    pub frames_on_table: usize,
}

/// Each point is a member of several surfels, and surfels are not the surface: their word counts this much.
const DATA_SHARE: f64 = 0.2;
/// Residuals are never believed to be better than this.
const LEAST_SIGMA_M: f64 = 1e-4;

/// Surfels and their data at these poses.
pub(crate) fn look(problem: &Problem, poses: &[FramePose], plan: &StepPlan) -> Seen {
    let cloud = Cloud::sample(problem, poses, plan.points, plan.surfels.radius_m, plan.seed);
    let mut patches = build(&cloud, poses, &plan.surfels);
    let sigma_m = robust_sigma_m(&patches);
    let weight = DATA_SHARE / sigma_m.max(0.5 * plan.scale_m[0]).max(LEAST_SIGMA_M).powi(2);
    let looked_for = plan.table && plan.surfels.scale_m <= table::SCALE_M;
    let table = looked_for.then(|| table::patch(&cloud, poses)).flatten();
    let frames_on_table = table.as_ref().map_or(0, table::frames);
    patches.extend(table);
    let frames = frame_data(&patches, weight, poses.len());
    Seen { patches, frames, sigma_m, weight, sampled: cloud.points.len(), share: cloud.share, frames_on_table }
}

/// Adds one step to the unknowns `x`. Returns what was seen before the step, or `None` when there is no finite step.
pub(crate) fn step(problem: &Problem, prior: &Prior, plan: &StepPlan, x: &mut [f64]) -> Option<Seen> {
    let poses = problem.poses(x);
    let seen = look(problem, &poses, plan);
    let (unknowns, free) = (&problem.unknowns, &plan.free);
    let rows: Vec<&Row> = poses.iter().map(|pose| &pose.row).collect();
    let mut force = vec![0.0; x.len()];
    prior.add_product(unknowns, free, x, &mut force);
    force.iter_mut().for_each(|f| *f = -*f);
    for (row, data) in rows.iter().zip(&seen.frames) {
        unknowns.spread(row, &data.force, free, &mut force);
    }
    let preconditioner = Preconditioner::new(unknowns, free, &rows, &seen.frames, prior);
    let mut room = Room::new(&seen.patches, rows.len());
    let apply = |v: &[f64]| {
        let corrections: Vec<Vector6<f64>> =
            rows.par_iter().with_min_len(FRAMES_A_TASK).map(|row| unknowns.correction(row, v, true)).collect();
        let forces = product(&seen.patches, seen.weight, &corrections, &mut room);
        let mut out = vec![0.0; v.len()];
        prior.add_product(unknowns, free, v, &mut out);
        rows.iter().zip(&forces).for_each(|(row, force)| unknowns.spread(row, force, free, &mut out));
        out
    };
    const TOLERANCE: f64 = 1e-3;
    let change =
        pcg::solve(&force, plan.cg_steps, TOLERANCE, apply, |residual| preconditioner.apply(unknowns, residual))?;
    x.iter_mut().zip(change).for_each(|(x, change)| *x += change);
    Some(seen)
}
