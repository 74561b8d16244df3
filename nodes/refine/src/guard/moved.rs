//! Was the thing moved in mid-scan?
//!
//! Then no poses bring together what was seen before and behind that moment: where both saw the same piece of surface
//! they stand apart, and they stand farthest apart when the scan is divided just there.

use crate::scene::Problem;
use crate::surfel::Patch;

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
const FEWEST_MEMBERS: usize = 3;
const FEWEST_SURFELS: usize = 30;
const UPPER: f64 = 0.9;

/// Tries all moments. `None` when no piece of surface was seen twice.
pub(crate) fn divide(problem: &Problem, patches: &[Patch]) -> Option<Divided> {
    let end_s = problem.frames.last()?.t_s;
    let moments = (1..(end_s / STEP_S) as usize).map(|i| i as f64 * STEP_S);
    let mut tried: Vec<(f64, f64, usize)> = moments
        .filter_map(|t_s| {
            let mut apart: Vec<f64> =
                patches.iter().flat_map(Patch::surfels).filter_map(|members| offset(problem, members, t_s)).collect();
            let surfels = apart.len();
            if surfels < FEWEST_SURFELS {
                return None;
            }
            let place = ((surfels - 1) as f64 * UPPER) as usize;
            Some((t_s, *apart.select_nth_unstable_by(place, f64::total_cmp).1, surfels))
        })
        .collect();
    let most = tried.iter().copied().reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    let middle = tried.len() / 2;
    let usual_m = tried.select_nth_unstable_by(middle, |a, b| a.1.total_cmp(&b.1)).1.1;
    Some(Divided { t_s: most.0, apart_m: most.1, usual_m, surfels: most.2 })
}

fn offset(problem: &Problem, members: &[crate::surfel::Member], t_s: f64) -> Option<f64> {
    let mut sides = [(0.0, 0usize); 2];
    for member in members {
        let side = &mut sides[usize::from(problem.frames[member.frame as usize].t_s > t_s)];
        side.0 += f64::from(member.distance_m);
        side.1 += 1;
    }
    let [(a, n), (b, m)] = sides;
    (n.min(m) >= FEWEST_MEMBERS).then(|| (a / n as f64 - b / m as f64).abs())
}
