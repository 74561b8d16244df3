//! Which receivers agree, and what they say together.

use crate::solve::{Sighting, Solution, solve};

/// What the receivers that agree say.
#[derive(Debug, Clone)]
pub(crate) struct Agreement {
    pub solution: Solution,
    /// Those that do not agree with the rest: their places among the sightings, ascending.
    pub outliers: Vec<usize>,
    /// Numbers measured beyond the six that are asked for: by these chi-squared is divided.
    pub freedom: usize,
}

/// No more than half of the receivers agree: nothing can be believed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Contradiction {
    /// All stand so many times as far apart as they state.
    pub times: f64,
}

/// A pose and its six numbers.
const NUMBERS: usize = 6;

/// The pose by all receivers, as long as noise explains how far they are apart; else by all but the one without which the
/// others agree best, and so on while more than half are left. `None` when there is no sighting, or a lone one overflows.
pub(crate) fn agree(sightings: &[Sighting], outlier_sigmas: f64) -> Option<Result<Agreement, Contradiction>> {
    let all = sightings.len();
    let mut inside: Vec<usize> = (0..all).collect();
    let mut solution = by(sightings, &inside)?;
    let times = (solution.chi_squared / freedom(all) as f64).sqrt();
    while solution.chi_squared > chi_squared_limit(freedom(inside.len()), outlier_sigmas) {
        if 2 * (inside.len() - 1) <= all {
            return (all > 1).then_some(Err(Contradiction { times }));
        }
        let without = |&left_out: &usize| {
            let rest: Vec<usize> = inside.iter().copied().filter(|index| *index != left_out).collect();
            by(sightings, &rest).map(|solution| (rest, solution))
        };
        let rests = inside.iter().filter_map(without);
        (inside, solution) = rests.min_by(|a, b| a.1.chi_squared.total_cmp(&b.1.chi_squared))?;
    }
    let outliers = (0..all).filter(|index| !inside.contains(index)).collect();
    Some(Ok(Agreement { solution, outliers, freedom: freedom(inside.len()) }))
}

/// Numbers that so many receivers measure beyond the six that are asked for.
fn freedom(receivers: usize) -> usize {
    NUMBERS * receivers.saturating_sub(1)
}

fn by(sightings: &[Sighting], inside: &[usize]) -> Option<Solution> {
    let chosen: Vec<Sighting> = inside.iter().map(|&index| sightings[index]).collect();
    solve(&chosen)
}

/// What chi-squared exceeds as rarely as a normal number exceeds so many sigmas (Wilson and Hilferty 1931).
fn chi_squared_limit(freedom: usize, sigmas: f64) -> f64 {
    if freedom == 0 {
        return f64::MAX;
    }
    let spread = 2.0 / (9.0 * freedom as f64);
    freedom as f64 * (1.0 - spread + sigmas * spread.sqrt()).powi(3)
}
