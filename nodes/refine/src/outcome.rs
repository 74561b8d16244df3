//! From solved unknowns to what is given out: poses with their sigma, frames that fit, evidence.

use crate::Config;
use crate::evidence::{DropReason, DroppedFrame, FrameEvidence};
use crate::gather::Frame;
use crate::gauge;
use crate::judge::{FrameJudgement, Judgement, covariances};
use crate::prior::Prior;
use crate::refinement::RefinedFrame;
use crate::scene::{FramePose, Problem};
use crate::unknowns::Row;
use geometry::TimedPose;
use nalgebra::{Isometry3, Matrix6, Point3, Vector3, Vector6};
use rayon::prelude::*;

/// Frames with their poses in the tracker's world.
pub(crate) struct Outcome {
    pub trajectory: Vec<TimedPose>,
    pub frames: Vec<RefinedFrame>,
    pub kept: Vec<FrameEvidence>,
    pub dropped: Vec<DroppedFrame>,
}

/// Distance between samples of the way: the tremor of a hand (12 Hz, 0.3 mm) bends it by 1 micron between them.
const SAMPLE_NANOS: i64 = 2_000_000;
/// The way goes on so far before the first frame and behind the last, for pictures without a stripe.
const MARGIN_NANOS: i64 = 500_000_000;
/// Points that the gauge is fixed by.
const GAUGE_POINTS: usize = 20_000;
/// A frame is not dropped for a residual below this: it may be the grain of the surface.
const LEAST_MISFIT_M: f64 = 2e-4;
/// A tracker that is better than this puts no frame so far off that the surface could tell: what does not fit, or was seen
/// by nobody else, is the shape's own detail.
const GOOD_TRACKER_M: f64 = 3e-4;
/// A frame of which others saw less than this share may stand anywhere, and fit itself wherever it stands.
const LEAST_HELD: f64 = 0.2;
/// Unless little was seen twice at all.
const MOSTLY_SEEN_TWICE: f64 = 0.5;
/// From the handset to what it measures, about.
const LEVER_M: f64 = 0.2;
/// A frame whose points are known so many times worse than those of half of the frames is held by nothing ...
const UNHELD: f64 = 8.0;
/// ... when that is as much as this.
const LEAST_UNHELD_M: f64 = 7e-4;

/// Everything at the unknowns `x`, the whole laid onto the smoothed tracker; `regions_sigma_m` for each frame, or empty.
pub(crate) fn outcome(
    config: &Config,
    problem: &Problem,
    prior: &Prior,
    judged: &Judgement,
    regions_sigma_m: &[f64],
    x: &[f64],
) -> Outcome {
    let poses = problem.poses(x);
    let gauge = fixed(problem, &poses);
    let rows: Vec<&Row> = poses.iter().map(|pose| &pose.row).collect();
    let covariances = covariances(problem, &rows, judged, prior);
    let frame = |k: usize| {
        let (placed, pose, covariance) = (&problem.frames[k], &poses[k], &covariances[k]);
        let gathered = &problem.gathered.frames[placed.frame];
        let across_sigma_m = across_sigma_m(problem, pose, gathered, &judged.frames[k], covariance);
        let world_from_camera = gauge * pose.world_from_body * problem.body_from_camera;
        let [position_sigma_m, rotation_sigma_rad] = of_camera(&problem.body_from_camera, covariance);
        let stamp_nanos = placed.stamp_nanos;
        let pose = TimedPose { stamp_nanos, pose: world_from_camera, position_sigma_m, rotation_sigma_rad };
        let region_sigma_m = regions_sigma_m.get(k).copied().unwrap_or(0.0);
        RefinedFrame { header: gathered.header, points: gathered.points.clone(), pose, across_sigma_m, region_sigma_m }
    };
    let all: Vec<RefinedFrame> = (0..poses.len()).into_par_iter().map(frame).collect();
    let trajectory = trajectory(problem, x, &gauge, &all);
    let (mut kept, mut dropped, mut frames) = (Vec::new(), Vec::new(), Vec::new());
    let bounds = Bounds::new(config, problem, judged, &all);
    for (frame, judgement) in all.into_iter().zip(&judged.frames) {
        let stamp_nanos = frame.pose.stamp_nanos;
        let residual_mm = Some(judgement.residual_m * 1e3).filter(|residual| residual.is_finite());
        let sigma_m = frame.across_sigma_m;
        match bounds.reason(judgement, sigma_m) {
            Some(reason) => {
                dropped.push(DroppedFrame { stamp_nanos, reason, residual_mm, sigma_mm: sigma_m * 1e3 });
            }
            None => {
                kept.push(FrameEvidence { stamp_nanos, residual_mm, sigma_mm: sigma_m * 1e3, held: judgement.held });
                frames.push(frame);
            }
        }
    }
    Outcome { trajectory, frames, kept, dropped }
}

/// What no frame may exceed, or fall below.
struct Bounds {
    residual_m: f64,
    sigma_m: f64,
    held: f64,
}

impl Bounds {
    fn new(config: &Config, problem: &Problem, judged: &Judgement, frames: &[RefinedFrame]) -> Self {
        let [position_m, rotation_rad] = problem.smoothed.white();
        let is_good = position_m.hypot(rotation_rad * LEVER_M) < GOOD_TRACKER_M;
        let misfit = if is_good { f64::INFINITY } else { LEAST_MISFIT_M };
        let held = if is_good || judged.seen_twice < MOSTLY_SEEN_TWICE { 0.0 } else { LEAST_HELD };
        let residual = median(judged.frames.iter().map(|frame| frame.residual_m).filter(|r| r.is_finite()).collect());
        let sigma = median(frames.iter().map(|frame| frame.across_sigma_m).collect());
        Self {
            residual_m: (config.most_residual * residual).max(misfit),
            sigma_m: (UNHELD * sigma).max(LEAST_UNHELD_M),
            held,
        }
    }

    fn reason(&self, frame: &FrameJudgement, sigma_m: f64) -> Option<DropReason> {
        if frame.residual_m > self.residual_m {
            Some(DropReason::FitsNowhere)
        } else if sigma_m > self.sigma_m || frame.held < self.held {
            Some(DropReason::Unheld)
        } else {
            None
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// The rigid motion that lays the refined points back onto those of the smoothed tracker.
fn fixed(problem: &Problem, poses: &[FramePose]) -> Isometry3<f64> {
    let points: usize = problem.frames.iter().map(|placed| problem.gathered.frames[placed.frame].points.len()).sum();
    let stride = (points / GAUGE_POINTS).max(1);
    let (mut refined, mut smoothed) = (Vec::new(), Vec::new());
    let mut next = 0;
    for (placed, pose) in problem.frames.iter().zip(poses) {
        let points = &problem.gathered.frames[placed.frame].points;
        let (base, _) = problem.smoothed.base(placed.stamp_nanos, [0.0; 2]);
        while next < points.len() {
            let in_body = Point3::from(problem.in_body(&points[next].position_m));
            refined.push(pose.world_from_body * in_body);
            smoothed.push(base * in_body);
            next += stride;
        }
        next -= points.len();
    }
    gauge::rigid(&refined, &smoothed)
}

fn trajectory(problem: &Problem, x: &[f64], gauge: &Isometry3<f64>, frames: &[RefinedFrame]) -> Vec<TimedPose> {
    let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return Vec::new() };
    let from = first.pose.stamp_nanos - MARGIN_NANOS;
    let count = (last.pose.stamp_nanos + MARGIN_NANOS - from) / SAMPLE_NANOS;
    let offsets_s = problem.unknowns.offsets_s(x);
    let sample = |i: i64| {
        let stamp_nanos = from + i * SAMPLE_NANOS;
        problem.smoothed.at(stamp_nanos)?;
        let t_s = (stamp_nanos - problem.start_nanos()) as f64 * 1e-9;
        let (base, twist) = problem.smoothed.base(stamp_nanos, offsets_s);
        let row = problem.unknowns.row(t_s, base, twist, &problem.origin);
        let body = row.corrected(&problem.unknowns.correction(&row, x, false));
        let after = frames.partition_point(|frame| frame.pose.stamp_nanos < stamp_nanos).min(frames.len() - 1);
        let near = [&frames[after].pose, &frames[after.saturating_sub(1)].pose];
        Some(TimedPose {
            stamp_nanos,
            pose: gauge * body * problem.body_from_camera,
            position_sigma_m: near[0].position_sigma_m.max(near[1].position_sigma_m),
            rotation_sigma_rad: near[0].rotation_sigma_rad.max(near[1].rotation_sigma_rad),
        })
    };
    (0..=count).into_par_iter().filter_map(sample).collect()
}

/// How far the correction's error moves a frame's points across the surface: tr(mean J J^T, covariance), J as its
/// members have it; without members, J for a surface that may lie any way.
fn across_sigma_m(
    problem: &Problem,
    pose: &FramePose,
    frame: &Frame,
    judged: &FrameJudgement,
    c: &Matrix6<f64>,
) -> f64 {
    let mut across = judged.across;
    if judged.members == 0 {
        let middle = &frame.points[frame.points.len() / 2];
        let in_body = problem.in_body(&middle.position_m).cast::<f32>();
        across = Matrix6::zeros();
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let jacobian = Vector6::from(pose.jacobian(&axis, &in_body).map(f64::from));
            across.ger(1.0 / 3.0, &jacobian, &jacobian, 1.0);
        }
    }
    (across * c).trace().max(0.0).sqrt()
}

/// One standard deviation of the camera's position (m) and rotation (rad), one axis of three.
fn of_camera(body_from_camera: &Isometry3<f64>, c: &Matrix6<f64>) -> [f64; 2] {
    let mut to_camera = Matrix6::identity();
    let lever = body_from_camera.translation.vector.cross_matrix();
    to_camera.fixed_view_mut::<3, 3>(0, 3).copy_from(&-lever);
    let moved = to_camera * c * to_camera.transpose();
    [0, 3].map(|first| ((0..3).map(|i| moved[(first + i, first + i)]).sum::<f64>() / 3.0).max(0.0).sqrt())
}
