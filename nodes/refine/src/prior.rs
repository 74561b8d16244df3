//! What is believed before the surface is looked at: quadratic, all of mean zero.
//!
//! A hand moves smoothly, and trembles. The smoothed tracker minimises (readings + smoothness), so it stands for all
//! readings: what it left of their noise has the same quadratic form around it for its prior. The tremor, which is no
//! smoother than the knots allow but small, has a spline of its own; to make up for it by less smoothness lets the whole band
//! between the hand's movement and its tremor (2 to 8 Hz) go free, and where few strokes cross the surface does not hold it.

use crate::banded::Banded;
use crate::spline::Knots;
use crate::unknowns::{BIAS, Free, GLOBALS, MONOMIALS, NOISE, SPLINES, TREMOR, Unknowns};
use geometry::sign;

/// Standard deviations of the unknowns, in metres, radians and seconds; pairs are (position, rotation).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Beliefs {
    /// The tracker's white noise, along one axis.
    pub white: [f64; 2],
    /// How many times its variance the readings have where it counts.
    pub inflation: [f64; 2],
    /// Weight of the squared third differences of the noise's knots.
    pub smoothness: [f64; 2],
    pub tremor: [f64; 2],
    pub bias: [f64; 2],
    pub field: [f64; 2],
    pub hand_eye: [f64; 2],
    pub clock_s: f64,
    pub lag_s: f64,
}

/// Where no reading holds what is left of the noise, it is still no larger than this.
const FAR: [f64; 2] = [0.03, 0.3];
/// Second differences of the slow correction count so much more than its size.
const BIAS_BEND: f64 = 4.0;

/// The precision matrix P of the prior.
#[derive(Debug, Clone)]
pub(crate) struct Prior {
    /// Of each spline one axis of position, one of rotation.
    splines: [[Banded; 2]; SPLINES],
    /// The readings' part of that of the noise, at the variance that the smoother found.
    readings: [Banded; 2],
    globals: [f64; GLOBALS],
}

impl Prior {
    /// `reading_times_s` are on the splines' time.
    pub fn new(unknowns: &Unknowns, reading_times_s: &[f64], beliefs: &Beliefs) -> Self {
        let gram = [TREMOR, NOISE].map(|which| gram(&unknowns.splines[which], reading_times_s));
        let readings = |which: usize| [0, 1].map(|kind| gram[which].clone().scaled(beliefs.white[kind].powi(-2)));
        let held = |which: usize, most: [f64; 2]| {
            let bands = readings(which);
            [0, 1].map(|kind| {
                let mut band = bands[kind].clone().scaled(1.0 / beliefs.inflation[kind]);
                (0..band.size).for_each(|row| band.add(row, row, most[kind].powi(-2)));
                band
            })
        };
        let mut noise = held(NOISE, FAR);
        let third = [-1.0, 3.0, -3.0, 1.0];
        noise.iter_mut().zip(beliefs.smoothness).for_each(|(band, weight)| add_differences(band, &third, weight));
        let bias = [0, 1].map(|kind| {
            let mut band = Banded::zeros(unknowns.splines[BIAS].count, 2);
            let weight = beliefs.bias[kind].powi(-2);
            (0..band.size).for_each(|row| band.add(row, row, weight));
            add_differences(&mut band, &[1.0, -2.0, 1.0], BIAS_BEND * weight);
            band
        });
        let of_kind = |sigmas: [f64; 2], i: usize| sigmas[usize::from(i % 6 >= 3)];
        let sigma = |i: usize| match i {
            i if i < 6 * MONOMIALS => of_kind(beliefs.field, i),
            i if i < 6 * MONOMIALS + 6 => of_kind(beliefs.hand_eye, i),
            i if i == 6 * MONOMIALS + 6 => beliefs.clock_s,
            _ => beliefs.lag_s,
        };
        let globals = std::array::from_fn(|i| sigma(i).powi(-2));
        Self { splines: [held(TREMOR, beliefs.tremor), noise, bias], readings: readings(NOISE), globals }
    }

    /// Adds P v to `out`, for the blocks that are free.
    pub fn add_product(&self, unknowns: &Unknowns, free: &Free, v: &[f64], out: &mut [f64]) {
        for (which, bands) in self.splines.iter().enumerate().filter(|(which, _)| free.splines[*which]) {
            let range = unknowns.spline(which);
            for axis in 0..6 {
                multiply(&bands[axis / 3], &v[range.clone()], &mut out[range.clone()], axis);
            }
        }
        let start = unknowns.globals().start;
        for (i, precision) in self.globals.iter().enumerate().filter(|(i, _)| free.global(*i)) {
            out[start + i] += precision * v[start + i];
        }
    }

    /// Forces of covariance P on the blocks that are free: L times signs, L L^T = P.
    pub fn shaken(&self, unknowns: &Unknowns, free: &Free, seed: u64) -> Vec<f64> {
        let mut out = vec![0.0; unknowns.len()];
        for (which, bands) in self.splines.iter().enumerate().filter(|(which, _)| free.splines[*which]) {
            let factors = bands.clone().map(Banded::factor);
            let first = unknowns.spline(which).start;
            for axis in 0..6 {
                let place = |i: usize| first + 6 * i + axis;
                let signs: Vec<f64> = (0..bands[0].size).map(|i| sign(seed, place(i) as u64)).collect();
                let forces = factors[axis / 3].product(&signs);
                forces.into_iter().enumerate().for_each(|(i, force)| out[place(i)] = force);
            }
        }
        let start = unknowns.globals().start;
        for (i, precision) in self.globals.iter().enumerate().filter(|(i, _)| free.global(*i)) {
            out[start + i] = precision.sqrt() * sign(seed, (start + i) as u64);
        }
        out
    }

    /// Adds P to the block of a spline, as the preconditioner holds it.
    pub fn add_to_band(&self, which: usize, band: &mut Banded) {
        let bands = &self.splines[which];
        for row in 0..bands[0].size {
            for column in row.saturating_sub(bands[0].half_bandwidth())..=row {
                for axis in 0..6 {
                    band.add(6 * row + axis, 6 * column + axis, bands[axis / 3].at(row, column));
                }
            }
        }
    }

    /// One axis of what is left of the noise: 0 position, 1 rotation.
    pub fn noise(&self, kind: usize) -> &Banded {
        &self.splines[NOISE][kind]
    }

    /// The readings' part of it, not inflated.
    pub fn readings(&self, kind: usize) -> &Banded {
        &self.readings[kind]
    }

    /// The precisions of field, hand-eye, clock and lag.
    pub fn globals(&self) -> &[f64; GLOBALS] {
        &self.globals
    }
}

/// Sum over the moments of B(t) B(t)^T.
fn gram(knots: &Knots, times_s: &[f64]) -> Banded {
    let mut band = Banded::zeros(knots.count, 3);
    for t in times_s {
        let (first, weights) = knots.weights(*t);
        for a in 0..4 {
            for b in 0..=a {
                band.add(first + a, first + b, weights[a] * weights[b]);
            }
        }
    }
    band
}

fn add_differences(band: &mut Banded, stencil: &[f64], weight: f64) {
    for first in 0..(band.size + 1).saturating_sub(stencil.len()) {
        for a in 0..stencil.len() {
            for b in 0..=a {
                band.add(first + a, first + b, weight * stencil[a] * stencil[b]);
            }
        }
    }
}

/// out += band v, along one of the six axes that lie interleaved.
fn multiply(band: &Banded, v: &[f64], out: &mut [f64], axis: usize) {
    let reach = band.half_bandwidth();
    for row in 0..band.size {
        for column in row.saturating_sub(reach)..row {
            let value = band.at(row, column);
            out[6 * row + axis] += value * v[6 * column + axis];
            out[6 * column + axis] += value * v[6 * row + axis];
        }
        out[6 * row + axis] += band.at(row, row) * v[6 * row + axis];
    }
}
