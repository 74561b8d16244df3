//! Was the thing moved in mid-scan?
//!
//! Then no poses bring together what was seen before and behind that moment: where both saw the same piece of surface
//! they stand apart, and they stand farthest apart when the scan is divided just there.

use crate::scene::Problem;
use crate::surfel::{Member, Patch};

/// The scan, divided at its most suspicious moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Divided {
    /// On the splines' time.
    pub t_s: f64,
    /// How far what was seen before stands from what was seen behind: the upper tenth of the surfels, metres.
    pub apart_m: f64,
    /// The same at a usual moment.
    pub usual_m: f64,
    /// How many surfels were seen before and behind.
    pub surfels: usize,
}

const STEP_S: f64 = 0.5;
const FEWEST_MEMBERS: usize = 5;
const FEWEST_SURFELS: usize = 30;
const UPPER: f64 = 0.9;

/// Tries all moments. `None` when no piece of surface was seen twice.
pub(crate) fn divide(problem: &Problem, patches: &[Patch]) -> Option<Divided> {
    let end_s = problem.frames.last()?.t_s;
    let moments = (1..(end_s / STEP_S) as usize).map(|i| i as f64 * STEP_S);
    let mut tried: Vec<(f64, f64, usize)> = moments
        .filter_map(|t_s| {
            let apart: Vec<f64> =
                patches.iter().flat_map(Patch::surfels).filter_map(|members| offset(problem, members, t_s)).collect();
            let surfels = apart.len();
            if surfels < FEWEST_SURFELS {
                return None;
            }
            Some((t_s, apart.iter().sum::<f64>() / surfels as f64, surfels))
        })
        .collect();
    let most = tried.iter().copied().reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    let middle = tried.len() / 2;
    let usual_m = tried.select_nth_unstable_by(middle, |a, b| a.1.total_cmp(&b.1)).1.1;
    Some(Divided { t_s: most.0, apart_m: most.1, usual_m, surfels: most.2 })
}

/// Between the medians of both sides, because outliers lie far.
fn offset(problem: &Problem, members: &[Member], t_s: f64) -> Option<f64> {
    let mut sides: [Vec<f32>; 2] = Default::default();
    for member in members {
        sides[usize::from(problem.frames[member.frame as usize].t_s > t_s)].push(member.distance_m);
    }
    if sides.iter().any(|side| side.len() < FEWEST_MEMBERS) {
        return None;
    }
    let [a, b] = sides.map(|mut side| {
        let middle = side.len() / 2;
        f64::from(*side.select_nth_unstable_by(middle, f32::total_cmp).1)
    });
    Some((a - b).abs())
}
