//! How far whole regions of the surface may stand off together: draws from what the scan leaves open.
//!
//! A solution of H x = b, with b of covariance H, has the covariance H^-1 of the unknowns (Papandreou and Yuille 2010,
//! "Gaussian sampling by local perturbations"). Such a b is what the prior and the members of the surfels give when each is
//! moved by one standard deviation. How far a draw moves a surfel as a whole, no number of points averages away.

use crate::surfel::{Member, SurfelMiddle};
use crate::system::System;
use geometry::word;
use nalgebra::{Matrix6, Vector3, Vector6};
use rayon::prelude::*;

/// A sigma from so many draws is itself known to a quarter, before it is averaged over what a frame saw.
const DRAWS: u64 = 8;
/// One in so many surfels is enough to tell.
pub(crate) const ONE_SURFEL_IN: usize = 4;
/// Of conjugate gradients: what comes later moves the whole, which is taken out again.
const CG_STEPS: usize = 40;

/// 1 or -1, evenly.
pub(crate) fn sign(seed: u64, index: u64) -> f64 {
    if word(seed, index) & 1 == 0 { 1.0 } else { -1.0 }
}

/// For each frame one standard deviation, in metres, of the surface that it saw: root mean square over its memberships. A
/// frame without any has the median of the others; NaN when there is none.
pub(crate) fn region_sigmas_m(system: &System, information_m2: f64, seed: u64) -> Vec<f64> {
    let patches = &system.seen.patches;
    let middles: Vec<&SurfelMiddle> = patches.iter().flat_map(|patch| &patch.middles).collect();
    let draw = |draw: u64| {
        let x = system.solve(&system.shaken(information_m2, word(seed, draw)), CG_STEPS)?;
        let corrections = system.corrections(&x);
        let surfels = patches.iter().flat_map(|patch| patch.surfels());
        let mut moved: Vec<f64> = surfels.map(|members| moved(members, &corrections)).collect();
        moved.truncate(middles.len());
        lay_back(&middles, &mut moved);
        Some(moved)
    };
    let draws: Vec<Vec<f64>> = (0..DRAWS).into_par_iter().filter_map(draw).collect();
    let variance = |i: usize| draws.iter().map(|moved| moved[i] * moved[i]).sum::<f64>() / draws.len() as f64;
    let mut sums = vec![[0.0; 2]; system.frames()];
    let surfels = patches.iter().flat_map(|patch| patch.surfels());
    for (members, i) in surfels.zip(0..middles.len()) {
        let variance = variance(i);
        for member in members {
            let weight = f64::from(member.root_weight).powi(2);
            let sum = &mut sums[member.frame as usize];
            *sum = [sum[0] + weight, sum[1] + weight * variance];
        }
    }
    let sigma = |[weight, variance]: &[f64; 2]| (*weight > 0.0).then(|| (variance / weight).sqrt());
    let mut known: Vec<f64> = sums.iter().filter_map(sigma).collect();
    known.sort_unstable_by(f64::total_cmp);
    let median = known.get(known.len() / 2).copied().unwrap_or(f64::NAN);
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

/// Takes out the rigid motion: where the whole stands is another matter.
fn lay_back(middles: &[&SurfelMiddle], moved: &mut [f64]) {
    let row = |middle: &SurfelMiddle| {
        let (n, p): (Vector3<f64>, Vector3<f64>) = (middle.normal.cast(), middle.position.cast());
        let turn = p.cross(&n);
        Vector6::new(n.x, n.y, n.z, turn.x, turn.y, turn.z)
    };
    let (mut normal, mut right) = (Matrix6::zeros(), Vector6::zeros());
    for (middle, moved) in middles.iter().zip(moved.iter()) {
        let row = row(middle);
        normal.ger(1.0, &row, &row, 1.0);
        right += row * *moved;
    }
    // A plane lets itself be moved along: then nothing is taken out.
    let Some(motion) = normal.cholesky().map(|cholesky| cholesky.solve(&right)) else { return };
    for (middle, moved) in middles.iter().zip(moved.iter_mut()) {
        *moved -= row(middle).dot(&motion);
    }
}
