//! Is the tracker's noise as white as the smoother took it for?
//!
//! Cross-validation sees only how readings differ from their neighbours. Noise that lasts for some tenths of a second
//! goes into the smoothed way unseen, and a prior that counts every reading as a new one is too stiff for it. Where the
//! surface holds the way, the correction shows it: it is larger than the prior allows.

use crate::banded::Banded;
use crate::prior::Prior;
use crate::unknowns::{NOISE, Unknowns};

/// How many times the stated variance the readings have, position and rotation, as the correction `xi` of the noise shows it:
/// the evidence's fixed point xi' G xi / (tr G P^-1 - tr G H^-1) (MacKay 1992, "Bayesian interpolation", equation 4.10),
/// G being the readings' part of the prior at the stated variance, P the prior and H prior and data together. `None`
/// when the data hold too little to tell.
pub(crate) fn inflation(unknowns: &Unknowns, prior: &Prior, posterior: Banded, x: &[f64]) -> [Option<f64>; 2] {
    let inverse = posterior.factor().inverse_band();
    [0, 1].map(|kind| {
        let readings = prior.readings(kind);
        let before = trace_of_product(readings, &prior.noise(kind).clone().factor().inverse_band(), |i| i);
        let (mut energy, mut held) = (0.0, 0.0);
        for axis in 3 * kind..3 * kind + 3 {
            energy += quadratic(readings, &x[unknowns.spline(NOISE)], axis);
            held += before - trace_of_product(readings, &inverse, |i| 6 * i + axis);
        }
        (held > FEWEST_HELD).then(|| energy / held)
    })
}

/// Of that correction's unknowns, so many must be held by data.
const FEWEST_HELD: f64 = 30.0;

/// tr(A B), rows of A standing at `place` in B; bands as wide as A's.
fn trace_of_product(a: &Banded, b: &Banded, place: impl Fn(usize) -> usize) -> f64 {
    let mut sum = 0.0;
    for row in 0..a.size {
        for column in row.saturating_sub(a.half_bandwidth())..=row {
            let twice = if row == column { 1.0 } else { 2.0 };
            sum += twice * a.at(row, column) * b.at(place(row), place(column));
        }
    }
    sum
}

/// v' A v along one of six axes that lie interleaved.
fn quadratic(a: &Banded, v: &[f64], axis: usize) -> f64 {
    let mut sum = 0.0;
    for row in 0..a.size {
        for column in row.saturating_sub(a.half_bandwidth())..=row {
            let twice = if row == column { 1.0 } else { 2.0 };
            sum += twice * a.at(row, column) * v[6 * row + axis] * v[6 * column + axis];
        }
    }
    sum
}
