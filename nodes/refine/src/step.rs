//! One Gauss-Newton step: surfels at the present poses, and the correction that brings their points together.

use crate::cloud::Cloud;
use crate::prior::Prior;
use crate::scene::{FramePose, Problem};
use crate::schur::{FrameData, frame_data, robust_sigma_m};
use crate::surfel::{Patch, SurfelPlan, build};
use crate::system::System;
use crate::table;
use crate::unknowns::Free;
use geometry::word;

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

impl Seen {
    /// About one in so many surfels, picked by `seed`, which stand for all: their weight is larger.
    pub fn thinned(&self, one_in: u64, seed: u64) -> Self {
        let mut number = 0..;
        let mut is_kept = || number.next().is_some_and(|i| word(seed, i).is_multiple_of(one_in));
        let patches: Vec<Patch> = self.patches.iter().map(|patch| patch.thinned(&mut is_kept)).collect();
        let members = |patches: &[Patch]| patches.iter().map(|patch| patch.members.len()).sum::<usize>();
        let weight = self.weight * members(&self.patches) as f64 / members(&patches).max(1) as f64;
        let frames = frame_data(&patches, weight, self.frames.len());
        Self { patches, frames, weight, ..*self }
    }

    /// As if the members had said nothing.
    pub fn unheard(mut self) -> Self {
        self.weight = 0.0;
        for frame in &mut self.frames {
            *frame = FrameData { members: frame.members, ..FrameData::none() };
        }
        self
    }
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
    let system = System::new(problem, prior, &seen, &plan.free, &poses);
    let mut force = system.believed(x);
    force.iter_mut().for_each(|f| *f = -*f);
    system.spread(seen.frames.iter().map(|frame| &frame.force), &mut force);
    let change = system.solve(&force, plan.cg_steps)?;
    x.iter_mut().zip(change).for_each(|(x, change)| *x += change);
    Some(seen)
}
