//! The whole schedule on one scan.

use crate::Config;
use crate::gather::{Frame, Gathered};
use crate::guard::coloured;
use crate::guard::moved::{self, Divided};
use crate::precondition::spline_block;
use crate::prior::{Beliefs, Prior};
use crate::scene::{Placed, Problem};
use crate::schedule::{CG_STEPS, SCHEDULE, SECOND_PASS, STAGE_SEEDS, STAGES, Stage, wide};
use crate::spline::Knots;
use crate::step::{Seen, StepPlan, look, step};
use crate::tracker::Smoothed;
use crate::unknowns::{Free, NOISE, Row, Unknowns};
use geometry::word;
use nalgebra::{Isometry3, Vector3};

/// How the tracker's noise is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Noise {
    /// The readings' variance where it counts, in units of what the smoother found.
    pub inflation: f64,
    pub bias_knot_s: f64,
    /// Size of the slow correction, in units of what the configuration says.
    pub bias_size: f64,
}

impl Noise {
    /// As it is taken before anything is known of it.
    pub fn white(config: &Config) -> Self {
        Self { inflation: 1.0, bias_knot_s: config.bias_knot_ms * 1e-3, bias_size: 1.0 }
    }

    /// A third of a second: believed so much less, and brought back by slow corrections that are quicker and larger.
    fn coloured(config: &Config) -> Self {
        let bias_knot_s = (config.bias_knot_ms * 1e-3).min(COLOURED_KNOT_S);
        Self { inflation: COLOURED_INFLATION, bias_knot_s, bias_size: COLOURED_SIZE }
    }
}

/// The frames that have a pose, and the splines over them.
pub(crate) fn place(gathered: &Gathered, smoothed: &Smoothed) -> Vec<Placed> {
    let start = gathered.frames.first().map_or(0, Frame::stamp_nanos);
    let placed = |(i, frame): (usize, &Frame)| {
        smoothed.at(frame.stamp_nanos())?;
        let t_s = frame.stamp_nanos().saturating_sub(start) as f64 * 1e-9;
        Some(Placed { frame: i, stamp_nanos: frame.stamp_nanos(), t_s })
    };
    gathered.frames.iter().enumerate().filter_map(placed).collect()
}

/// The unknowns and the fixed things around them.
pub(crate) fn problem<'a>(
    config: &Config,
    noise: &Noise,
    gathered: &'a Gathered,
    smoothed: &'a Smoothed,
    frames: &'a [Placed],
    body_from_camera: Isometry3<f64>,
) -> Problem<'a> {
    let end_s = frames.last().map_or(0.0, |frame| frame.t_s);
    let unknowns = Unknowns {
        splines: [config.knot_ms * 1e-3, config.noise_knot_ms * 1e-3, noise.bias_knot_s]
            .map(|step_s| Knots::over(0.0, end_s, step_s)),
    };
    let places = frames.iter().filter_map(|frame| smoothed.at(frame.stamp_nanos));
    let sum: Vector3<f64> = places.map(|pose| pose.translation.vector).sum();
    let origin = sum / frames.len().max(1) as f64;
    Problem { gathered, smoothed, body_from_camera, frames, unknowns, origin }
}

/// What is believed of the unknowns.
pub(crate) fn prior(config: &Config, noise: &Noise, problem: &Problem) -> Prior {
    let span = 0.0..=problem.frames.last().map_or(0.0, |frame| frame.t_s);
    let times =
        problem.gathered.readings.iter().map(|r| r.stamp_nanos.saturating_sub(problem.start_nanos()) as f64 * 1e-9);
    let times: Vec<f64> = times.filter(|t| span.contains(t)).collect();
    let white = problem.smoothed.white().map(|sigma| sigma.max(LEAST_WHITE));
    let stiffness = problem.smoothed.stiffness(config.noise_knot_ms * 1e-3);
    let deg = f64::to_radians;
    let slow = |most: [f64; 2]| [0, 1].map(|k| most[k].min(SLOW_PER_WHITE * white[k]));
    let beliefs = Beliefs {
        white,
        inflation: [noise.inflation; 2],
        smoothness: [0, 1].map(|k| config.smoothness * stiffness[k].max(LEAST_STIFFNESS) / white[k].powi(2)),
        tremor: [config.tremor_mm * 1e-3, deg(config.tremor_deg)],
        bias: slow([config.bias_position_mm * 1e-3, deg(config.bias_rotation_deg)].map(|most| most * noise.bias_size)),
        field: slow([config.field_position_mm * 1e-3, deg(config.field_rotation_deg)]),
        hand_eye: [config.hand_eye_mm * 1e-3, deg(config.hand_eye_deg)],
        clock_s: config.clock_ms * 1e-3,
        lag_s: config.rotation_lag_ms * 1e-3,
    };
    Prior::new(&problem.unknowns, &times, &beliefs)
}

/// A tracker's slow errors are no larger than so many times its noise: one that is quiet is a good one.
const SLOW_PER_WHITE: f64 = 20.0;
/// A perfect tracker would make the prior infinitely stiff.
const LEAST_WHITE: f64 = 1e-7;
const LEAST_STIFFNESS: f64 = 1e-3;

/// What came of the steps of one or more stages.
pub(crate) struct Progress {
    /// What the last step saw before it moved.
    pub seen: Seen,
    /// A step was not finite, or made things worse, and was taken back.
    pub taken_back: bool,
}

/// A step that makes the residuals so many times as large as they were is taken back.
const WORSE: f64 = 1.5;
/// A stage ends when a step gains less than this share ...
const GAIN: f64 = 0.93;
/// ... but not before this step, nor later than that one.
const FEWEST_STEPS: usize = 2;
const MOST_STEPS: usize = 8;

/// Short scans are held by few crossings, and what warps them as a whole comes late in conjugate gradients; and they can pay
/// for more of them: so many steps times frames.
const CG_FRAMES: usize = 32_000;
const MOST_CG_STEPS: usize = 180;

/// Steps of conjugate gradients for such a scan.
pub(crate) fn cg_steps(problem: &Problem) -> usize {
    (CG_FRAMES / problem.frames.len().max(1)).clamp(CG_STEPS, MOST_CG_STEPS)
}

/// The steps of one stage, from `x`. `scale_m` is the robust scale and goes on from stage to stage.
pub(crate) fn run_stage(
    config: &Config,
    problem: &Problem,
    prior: &Prior,
    (number, stage): (usize, &Stage),
    free: Free,
    scale_m: &mut f64,
    x: &mut Vec<f64>,
) -> Option<Progress> {
    let mut progress: Option<Progress> = None;
    let mut before = x.clone();
    for i in 0..MOST_STEPS {
        let seed = word(config.seed, STAGE_SEEDS * number as u64 + i as u64);
        let now = x.clone();
        let plan =
            StepPlan { table: config.flat_table, cg_steps: cg_steps(problem), ..stage.plan(free, *scale_m, seed) };
        let Some(seen) = step(problem, prior, &plan, x) else {
            *x = now;
            return progress.map(|progress| Progress { taken_back: true, ..progress });
        };
        let last = progress.as_ref().map_or(f64::INFINITY, |progress| progress.seen.sigma_m);
        if seen.sigma_m > WORSE * last {
            *x = before;
            return progress.map(|progress| Progress { taken_back: true, ..progress });
        }
        before = now;
        *scale_m = 2.0 * seen.sigma_m;
        let enough = seen.sigma_m > GAIN * last && i + 1 >= FEWEST_STEPS;
        progress = Some(Progress { seen, taken_back: false });
        if enough {
            break;
        }
    }
    progress
}

/// How many times the stated variance the readings seem to have after a stage: the larger of position and rotation.
pub(crate) fn excess(problem: &Problem, prior: &Prior, seen: &Seen, x: &[f64]) -> Option<f64> {
    let rows = problem.rows(x);
    let rows: Vec<&Row> = rows.iter().collect();
    let posterior = spline_block(&problem.unknowns, NOISE, &rows, &seen.frames, prior);
    let found = coloured::inflation(&problem.unknowns, prior, posterior, x);
    found.into_iter().flatten().reduce(f64::max)
}

/// A finished schedule.
pub(crate) struct Solution {
    pub x: Vec<f64>,
    pub free: Free,
    /// The most suspicious moment after the first pass, and the residuals then.
    pub moved: Option<(Divided, f64)>,
    pub noise: Noise,
    /// See [`coloured`]; `None` when too little is held.
    pub excess: Option<f64>,
    pub taken_back: bool,
    /// In the last stage, see [`Seen`].
    pub frames_on_table: usize,
}

/// Above this the noise is not white: 0.14 to 0.43 is what white noise and fields give, 0.66 and more what noise of 0.3 s
/// gives (the data are counted several times, so it is not 1).
const COLOURED: f64 = 0.55;
const COLOURED_INFLATION: f64 = 30.0;
const COLOURED_SIZE: f64 = 2.0;
const COLOURED_KNOT_S: f64 = 0.2;

/// All stages from nothing. The tracker's noise is judged after the second; when it is coloured all begins again, and
/// the prior believes the readings less.
pub(crate) fn run<'a>(
    config: &Config,
    free: Free,
    gathered: &'a Gathered,
    smoothed: &'a Smoothed,
    frames: &'a [Placed],
    body_from_camera: Isometry3<f64>,
) -> (Problem<'a>, Solution) {
    let white = Noise::white(config);
    let mut noise = white;
    let mut excess_found = None;
    loop {
        let problem = problem(config, &noise, gathered, smoothed, frames, body_from_camera);
        let prior = prior(config, &noise, &problem);
        let (mut x, mut scale_m, mut taken_back) = (vec![0.0; problem.unknowns.len()], f64::INFINITY, false);
        let (mut again, mut moved, mut frames_on_table) = (false, None, 0);
        for (number, &stage) in SCHEDULE.iter().enumerate() {
            if number >= SECOND_PASS {
                scale_m = f64::INFINITY;
            }
            if number == SECOND_PASS {
                // The second pass brings together even what was moved: it is looked for before.
                let seen = look(&problem, &problem.poses(&x), &wide(config.seed));
                moved = moved::divide(&problem, &seen.patches).map(|divided| (divided, seen.sigma_m));
            }
            let stage = &STAGES[stage];
            let progress = run_stage(config, &problem, &prior, (number, stage), free, &mut scale_m, &mut x);
            let Some(progress) = progress else { continue };
            taken_back |= progress.taken_back;
            frames_on_table = progress.seen.frames_on_table;
            if number == 1 && noise == white {
                excess_found = excess(&problem, &prior, &progress.seen, &x);
                again = excess_found.is_some_and(|excess| excess > COLOURED);
                if again {
                    break;
                }
            }
        }
        if !again {
            return (problem, Solution { x, free, moved, noise, excess: excess_found, taken_back, frames_on_table });
        }
        noise = Noise::coloured(config);
    }
}
