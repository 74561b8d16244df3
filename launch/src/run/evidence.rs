//! What a scan says of itself, in the words of its report: what refinement found, and how far points lie off the surface.

use super::Harvest;
use geometry::{METRES_PER_MM, MeshIndex, TriangleMesh};
use nalgebra::Point3;
use rayon::prelude::*;
use report::{FrameError, Observed, Refined, TrackerNoise};
use wire::{CloudPoint, FrameFit, Refinement};

/// What refinement says of its work; `without` is for whoever knows the truth.
pub fn refined(refinement: &Refinement) -> Refined {
    let mm = |metres: f64| metres / METRES_PER_MM;
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let ms = |nanos: i64| nanos as f64 * 1e-6;
    Refined {
        without: None,
        residual_before_mm: mm(refinement.residual_before_m),
        residual_after_mm: mm(refinement.residual_after_m),
        offset_error_ms: [ms(refinement.pose_offset_error_nanos), ms(refinement.pose_offset_sigma_nanos)],
        rotation_lag_ms: [ms(refinement.rotation_lag_error_nanos), ms(refinement.rotation_lag_sigma_nanos)],
        tracker: TrackerNoise {
            position_mm: mm(refinement.tracker.white_position_m),
            rotation_deg: refinement.tracker.white_rotation_rad.to_degrees(),
            excess: refinement.tracker.excess,
            inflation: refinement.tracker.inflation,
        },
        hand_eye_freed: refinement.hand_eye_freed,
        hand_eye_shift_mm: mm(length(refinement.hand_eye_shift_m)),
        hand_eye_shift_sigma_mm: mm(length(refinement.hand_eye_shift_sigma_m)),
        hand_eye_turn_deg: length(refinement.hand_eye_turn_rad).to_degrees(),
        hand_eye_turn_sigma_deg: length(refinement.hand_eye_turn_sigma_rad).to_degrees(),
        observed: refinement.observed.as_ref().map(|observed| Observed {
            crossing: observed.crossing,
            stripes_along: observed.stripes_along,
            held_directions: observed.held_directions,
        }),
        frame_sigma_mm: median_sigma_mm(&refinement.frames),
        frames_dropped: refinement.left_out().count() as u64,
        frames_unheld: refinement.unheld.len() as u64,
        frames: frames(refinement),
        notices: refinement.notices.clone(),
    }
}

fn median_sigma_mm(frames: &[FrameFit]) -> f64 {
    let mut sigmas: Vec<f32> = frames.iter().map(|frame| frame.sigma_m).collect();
    sigmas.sort_by(f32::total_cmp);
    f64::from(sigmas.get(sigmas.len() / 2).copied().unwrap_or_default()) / METRES_PER_MM
}

/// Those that were kept and those that were not, in the order of their stamps, from the first of them on.
fn frames(refinement: &Refinement) -> Vec<FrameError> {
    let all = || refinement.frames.iter().map(|f| (f, false)).chain(refinement.left_out().map(|f| (f, true)));
    let first = all().map(|(fit, _)| fit.stamp_nanos).min().unwrap_or_default();
    let error = |(fit, left_out): (&FrameFit, bool)| FrameError {
        at_s: fit.stamp_nanos.saturating_sub(first) as f64 * 1e-9,
        sigma_mm: f64::from(fit.sigma_m) / METRES_PER_MM,
        residual_mm: Some(f64::from(fit.residual_m) / METRES_PER_MM).filter(|mm| mm.is_finite()),
        left_out,
    };
    let mut frames: Vec<FrameError> = all().map(error).collect();
    frames.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    frames
}

impl Harvest {
    /// For each vertex of the final surface, how far the points about it lie off their tangent planes: root mean square over
    /// the balls whose closest triangle it belongs to, in metres; NaN where there is none. Empty without a surface.
    pub fn residuals_m(&self) -> Vec<f32> {
        self.mesh.as_ref().map_or_else(Vec::new, |mesh| residuals_m(&TriangleMesh::from(mesh), &self.cloud))
    }
}

fn residuals_m(mesh: &TriangleMesh, cloud: &[CloudPoint]) -> Vec<f32> {
    let Ok(index) = MeshIndex::new(mesh) else { return Vec::new() };
    let closest = |ball: &CloudPoint| index.closest(&Point3::from(ball.position_m).cast()).map(|hit| hit.triangle);
    let below: Vec<Option<u32>> = cloud.par_iter().map(closest).collect();
    let mut sums = vec![[0.0f64; 2]; mesh.vertices.len()];
    for (ball, triangle) in cloud.iter().zip(below) {
        let Some(triangle) = triangle else { continue };
        let points = f64::from(ball.count);
        for vertex in mesh.triangles[triangle as usize] {
            let [squares, weight] = &mut sums[vertex as usize];
            *squares += points * f64::from(ball.spread_m).powi(2);
            *weight += points;
        }
    }
    sums.iter().map(|[squares, weight]| (squares / weight).sqrt() as f32).collect()
}
