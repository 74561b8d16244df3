//! How far whole regions of the surface may stand off together: draws from what the scan leaves open.
//!
//! A solution of H x = b, with b of covariance H, has the covariance H^-1 of the unknowns (Papandreou and Yuille 2010,
//! "Gaussian sampling by local perturbations"). Here b is what the prior and the members of the surfels give when each is
//! moved by one standard deviation; members are better than their weight in H says, so the covariance is the sandwich
//! H^-1 (P + data as they are) H^-1 of an estimate with other weights than the best. How far a draw moves the surfels of a
//! region, more points of the same scan do not average away.

use crate::surfel::{Member, SurfelMiddle};
use crate::system::System;
use geometry::word;
use nalgebra::{Matrix6, Vector3, Vector6};
use rayon::prelude::*;

/// A sigma from so many draws is itself known to a quarter, before it is averaged over what a frame saw.
const DRAWS: u64 = 8;
/// One in so many surfels is enough to tell.
pub(crate) const ONE_SURFEL_IN: u64 = 4;
/// No other random choice has these seeds.
const SEEDS: u64 = 1 << 32;
/// The whole may move along what is this much softer than the rest: a plane along itself, a ball about its centre.
const SOFT: f64 = 1e-6;

type Surfel<'a> = (&'a [Member], &'a SurfelMiddle);

/// For each frame one standard deviation, in metres, of the surface that it saw: root mean square over its memberships. A
/// frame without any has the median of the others; 0 when nothing can be told.
pub(crate) fn region_sigmas_m(system: &System, information_m2: f64, cg_steps: usize, seed: u64) -> Vec<f64> {
    let patches = system.seen.patches.iter();
    let surfels: Vec<Surfel> = patches.flat_map(|patch| patch.surfels().zip(&patch.middles)).collect();
    if surfels.is_empty() {
        return vec![0.0; system.frames()];
    }
    let draw = |draw: u64| {
        let x = system.solve(&system.shaken(information_m2, word(seed, SEEDS + draw)), cg_steps)?;
        let corrections = system.corrections(&x);
        let mut moved: Vec<f64> = surfels.iter().map(|(members, _)| moved(members, &corrections)).collect();
        lay_back(&surfels, &mut moved);
        Some(moved)
    };
    let draws: Vec<Vec<f64>> = (0..DRAWS).into_par_iter().filter_map(draw).collect();
    if draws.is_empty() {
        return vec![0.0; system.frames()];
    }
    let mut sums = vec![[0.0; 2]; system.frames()];
    for (i, (members, _)) in surfels.iter().enumerate() {
        let variance = draws.iter().map(|moved| moved[i] * moved[i]).sum::<f64>() / draws.len() as f64;
        for member in *members {
            let weight = f64::from(member.root_weight).powi(2);
            let sum = &mut sums[member.frame as usize];
            *sum = [sum[0] + weight, sum[1] + weight * variance];
        }
    }
    let sigma = |[weight, variance]: &[f64; 2]| (*weight > 0.0).then(|| (variance / weight).sqrt());
    let mut known: Vec<f64> = sums.iter().filter_map(sigma).collect();
    known.sort_unstable_by(f64::total_cmp);
    let median = known.get(known.len() / 2).copied().unwrap_or(0.0);
    sums.iter().map(|sum| sigma(sum).unwrap_or(median)).collect()
}

/// How far a surfel moves along its normal when its frames are corrected so.
fn moved(members: &[Member], corrections: &[Vector6<f64>]) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for member in members {
        let correction = &corrections[member.frame as usize];
        let moves: f64 = (0..6).map(|i| f64::from(member.jacobian[i]) * correction[i]).sum();
        sum += f64::from(member.root_weight) * moves;
        weights += f64::from(member.root_weight).powi(2);
    }
    sum / weights.max(f64::MIN_POSITIVE)
}

/// Takes out the rigid motion: where the whole stands is another matter. What does not hold a motion says nothing of it.
fn lay_back(surfels: &[Surfel], moved: &mut [f64]) {
    let place = |(_, middle): &Surfel| -> Vector3<f64> { middle.position.cast() };
    let count = surfels.len().max(1) as f64;
    let centre = surfels.iter().map(place).sum::<Vector3<f64>>() / count;
    let spread_m = (surfels.iter().map(|s| (place(s) - centre).norm_squared()).sum::<f64>() / count).sqrt();
    let row = |surfel: &Surfel| {
        let n: Vector3<f64> = surfel.1.normal.cast();
        let turn = ((place(surfel) - centre) / spread_m.max(f64::MIN_POSITIVE)).cross(&n);
        Vector6::new(n.x, n.y, n.z, turn.x, turn.y, turn.z)
    };
    let (mut normal, mut right) = (Matrix6::zeros(), Vector6::zeros());
    for (surfel, moved) in surfels.iter().zip(moved.iter()) {
        let row = row(surfel);
        normal.ger(1.0, &row, &row, 1.0);
        right += row * *moved;
    }
    let eigen = normal.symmetric_eigen();
    let least = SOFT * eigen.eigenvalues.max();
    let mut motion = Vector6::zeros();
    for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > least {
            motion += direction * (direction.dot(&right) / value);
        }
    }
    for (surfel, moved) in surfels.iter().zip(moved.iter_mut()) {
        *moved -= row(surfel).dot(&motion);
    }
}
