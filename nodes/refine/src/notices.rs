//! When something is worth saying, and in which words.

use crate::evidence::Notice;
use crate::guard::strokes::{Hold, Strokes};
use crate::scene::Problem;
use crate::solver::Solution;

/// Parts of a thing that was moved stand apart by so many times the residuals (noise alone: 2) ...
const APART: f64 = 4.0;
/// ... and by this much at least.
const LEAST_APART_M: f64 = 3e-4;

/// What the schedule met.
pub(crate) fn notice_solution(solution: &Solution, notices: &mut Vec<Notice>) {
    if let Some(excess) = solution.excess.filter(|_| solution.noise.inflation > 1.0) {
        notices.push(Notice::ColouredNoise { excess });
    }
    if solution.taken_back {
        notices.push(Notice::StepTakenBack);
    }
}

/// What the surface itself shows: that it holds too little, or that the thing was moved.
pub(crate) fn notice_surface(problem: &Problem, solution: &Solution, hold: Hold, notices: &mut Vec<Notice>) {
    if hold.directions < 6 {
        notices.push(holds_little(hold));
    }
    let Some((divided, sigma_m)) = solution.moved else { return };
    if divided.apart_m > LEAST_APART_M.max(APART * sigma_m) {
        let stamp_nanos = problem.start_nanos() + (divided.t_s * 1e9) as i64;
        notices.insert(0, Notice::ThingMoved { stamp_nanos, apart_mm: divided.apart_m * 1e3 });
    }
}

/// Which stroke would make stripes cross.
pub(crate) fn missing_stroke(strokes: &Strokes) -> Notice {
    let [x, y, z] = strokes.along.into();
    let runs = if z.abs() > 0.7 { "upright".to_owned() } else { format!("along ({x:.2}, {y:.2}, {z:.2})") };
    let missing = if z.abs() > 0.7 { "level stripes" } else { "stripes across those" };
    let advice = format!(
        "most stripes run {runs} in the world: sweep once more over the same surface with {missing}, the handset rolled by \
         a quarter turn"
    );
    Notice::StrokesDoNotCross { crossing: strokes.crossing, advice }
}

/// What a surface without shape leaves open.
pub(crate) fn holds_little(hold: Hold) -> Notice {
    let advice = match hold.directions {
        0 => "no piece of surface was seen often enough".to_owned(),
        1..=3 => "the surface is a plane or a sphere, along which every stroke may slide: put something with edges beside it"
            .to_owned(),
        _ => "the surface is a cylinder, a cone or nearly so, along which strokes may slide: put something with edges beside it"
            .to_owned(),
    };
    Notice::SurfaceHoldsLittle { held_directions: hold.directions, advice }
}
