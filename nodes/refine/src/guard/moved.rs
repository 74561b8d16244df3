//! Was the thing moved in mid-scan?
//!
//! Then no poses bring together what was seen before and behind that moment: where both saw the same piece of surface
//! they stand apart, and most of all when the scan is divided just there. (A small push along a table is taken up by the
//! camera's way, and everything fits again: of that nothing is noticed, and nothing is spoilt.)

use crate::scene::Problem;
use crate::surfel::{Member, Patch};
use rayon::prelude::*;

/// The scan, divided at its most suspicious moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Divided {
    /// On the splines' time.
    pub t_s: f64,
    /// How far what was seen before stands from what was seen behind, on average over all surfels, metres.
    pub apart_m: f64,
}

const STEP_S: f64 = 0.5;
const FEWEST_MEMBERS: usize = 5;
const FEWEST_SURFELS: usize = 30;

/// Tries all moments. `None` when no piece of surface was seen twice.
pub(crate) fn divide(problem: &Problem, patches: &[Patch]) -> Option<Divided> {
    let end_s = problem.frames.last()?.t_s;
    // A long scan is tried no more often than one of a minute.
    let step_s = STEP_S.max(end_s / 120.0);
    let tried: Vec<Option<(Divided, f64)>> = (1..(end_s / step_s) as usize)
        .into_par_iter()
        .map(|i| {
            let t_s = i as f64 * step_s;
            let apart = patches.iter().flat_map(Patch::surfels).filter_map(|members| offset(problem, members, t_s));
            let (sum, count) = apart.fold((0.0, 0usize), |(sum, count), apart| (sum + apart, count + 1));
            let apart_m = sum / count as f64;
            // Few surfels scatter; a mean over n is as sure as its size times the root of n.
            (count >= FEWEST_SURFELS).then(|| (Divided { t_s, apart_m }, apart_m * (count as f64).sqrt()))
        })
        .collect();
    let most = tried.into_iter().flatten().reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    Some(most.0)
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
