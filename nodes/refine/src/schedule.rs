//! From coarse to fine: what is looked at, and what may move, in each stage.

use crate::step::StepPlan;
use crate::surfel::SurfelPlan;
use crate::unknowns::{Free, SPLINES, TREMOR};

/// One stage of the final refinement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stage {
    radius_mm: f32,
    spacing_mm: f32,
    points: usize,
    scale_mm: [f64; 2],
    slow_only: bool,
}

/// Large surfels first, while the cloud is a centimetre thick; at the end they are as small as the points allow.
pub(crate) const STAGES: [Stage; 5] = [
    Stage { radius_mm: 14.0, spacing_mm: 7.0, points: 30_000, scale_mm: [1.0, 5.0], slow_only: true },
    Stage { radius_mm: 14.0, spacing_mm: 7.0, points: 30_000, scale_mm: [1.0, 5.0], slow_only: false },
    Stage { radius_mm: 10.0, spacing_mm: 5.0, points: 50_000, scale_mm: [0.5, 3.0], slow_only: false },
    Stage { radius_mm: 7.0, spacing_mm: 4.0, points: 80_000, scale_mm: [0.3, 2.0], slow_only: false },
    Stage { radius_mm: 5.0, spacing_mm: 3.0, points: 150_000, scale_mm: [0.2, 1.0], slow_only: false },
];
/// The order of the stages. Frames that were lost on the way down are caught when all others are right already: so it
/// goes up once more, and to the finest stage only then.
pub(crate) const SCHEDULE: [usize; 8] = [0, 1, 2, 3, 1, 2, 3, 4];
/// From here on each stage begins with its widest robust scale, or the lost would not be looked at.
pub(crate) const SECOND_PASS: usize = 4;

/// The levels of a live tick.
pub(crate) const LIVE: [Stage; 3] = [
    Stage { radius_mm: 14.0, spacing_mm: 7.0, points: 30_000, scale_mm: [1.0, 5.0], slow_only: false },
    Stage { radius_mm: 10.0, spacing_mm: 7.0, points: 30_000, scale_mm: [0.5, 3.0], slow_only: false },
    Stage { radius_mm: 6.0, spacing_mm: 5.0, points: 60_000, scale_mm: [0.3, 2.0], slow_only: false },
];

/// Seeds of the stages are so far apart.
pub(crate) const STAGE_SEEDS: u64 = 64;
pub(crate) const MOST_MEMBERS: usize = 20;
/// Enough for a scan of a minute.
pub(crate) const CG_STEPS: usize = 30;

impl Stage {
    /// The plan of a step; `scale_m` is the robust scale now, `seed` differs from step to step.
    pub fn plan(&self, free: Free, scale_m: f64, seed: u64) -> StepPlan {
        let mut free = free;
        free.splines[TREMOR] &= !self.slow_only;
        let bounds = self.bounds_m();
        StepPlan {
            surfels: SurfelPlan {
                radius_m: self.radius_mm * 1e-3,
                spacing_m: self.spacing_mm * 1e-3,
                most_members: MOST_MEMBERS,
                scale_m: scale_m.clamp(bounds[0], bounds[1]) as f32,
                seed,
            },
            points: self.points,
            scale_m: bounds,
            free,
            table: false,
            cg_steps: CG_STEPS,
            seed,
        }
    }

    pub fn bounds_m(&self) -> [f64; 2] {
        self.scale_mm.map(|mm| mm * 1e-3)
    }
}

/// How the result is judged: as the last stage looks at it, always at the same points.
pub(crate) fn judging(seed: u64) -> StepPlan {
    looking(&STAGES[STAGES.len() - 1], seed)
}

/// A wide look, where parts that are some millimetres apart still meet.
pub(crate) fn wide(seed: u64) -> StepPlan {
    looking(&STAGES[2], seed)
}

/// How a tick is judged.
pub(crate) fn judging_live(seed: u64) -> StepPlan {
    looking(&LIVE[2], seed)
}

fn looking(stage: &Stage, seed: u64) -> StepPlan {
    let none = Free { splines: [false; SPLINES], field: false, hand_eye: false, clock: false, lag: false };
    stage.plan(none, f64::INFINITY, seed)
}
