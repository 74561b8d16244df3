//! The vector of all unknowns: which correction of the tracker stands where in it.
//!
//! A correction of frame k is a twist (dt, dr)_k: position in metres along, rotation in radians about the axes of the
//! smoothed body. It is a linear function of the unknowns,
//!
//!   (dt, dr)_k = sum of three splines at t_k + diag(R^T, R^T) sum phi_m(p_k) a_m + eta
//!
//! with splines for the hand's tremor that smoothing took off the way, for what smoothing left of the white noise, and for slow
//! errors; a the coefficients of a field of degree 2 in space, and eta the hand-eye correction; the clock offset tau moves
//! the base pose itself, and the lag of its orientations, where it is asked for, its rotation alone.

use crate::spline::Knots;
use nalgebra::{Isometry3, Matrix3, Vector3, Vector6};
use std::ops::Range;

/// Monomials of degree 2 and less.
pub(crate) const MONOMIALS: usize = 10;
const FIELD: usize = 6 * MONOMIALS;
/// Unknowns that all frames share: field, hand-eye, clock and the lag of the orientations.
pub(crate) const GLOBALS: usize = FIELD + 6 + 2;
/// The field's coordinates are in units of this.
const FIELD_LENGTH_M: f64 = 0.3;

/// The splines, by their places in [`Unknowns::splines`].
pub(crate) const SPLINES: usize = 3;
pub(crate) const TREMOR: usize = 0;
pub(crate) const NOISE: usize = 1;
pub(crate) const BIAS: usize = 2;

/// The unknowns stand in the order of the splines; the globals are behind them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Unknowns {
    pub splines: [Knots; SPLINES],
}

/// Which blocks are free to move.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Free {
    pub splines: [bool; SPLINES],
    pub field: bool,
    pub hand_eye: bool,
    pub clock: bool,
    /// The lag of the orientations, apart from the clock.
    pub lag: bool,
}

impl Free {
    /// Whether one of the globals may move, by its place among them.
    pub fn global(&self, which: usize) -> bool {
        match which {
            i if i < FIELD => self.field,
            i if i < FIELD + 6 => self.hand_eye,
            i if i == FIELD + 6 => self.clock,
            _ => self.lag,
        }
    }
}

/// One frame's row of the linear map from the unknowns to its correction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// First knot and weights of each spline.
    pub knots: [(usize, [f64; 4]); SPLINES],
    monomials: [f64; MONOMIALS],
    /// world_from_body of the smoothed tracker at t_k + tau.
    pub base: Isometry3<f64>,
    pub world_from_base: Matrix3<f64>,
    /// How the base moves by a second of tau, as a correction; by a second of lag it turns alone.
    twist: Vector6<f64>,
}

impl Unknowns {
    pub fn len(&self) -> usize {
        self.globals().end
    }

    /// Where a spline's control points are.
    pub fn spline(&self, which: usize) -> Range<usize> {
        let start = 6 * self.splines[..which].iter().map(|knots| knots.count).sum::<usize>();
        start..start + 6 * self.splines[which].count
    }

    pub fn globals(&self) -> Range<usize> {
        let start = self.spline(SPLINES - 1).end;
        start..start + GLOBALS
    }

    pub fn field(&self) -> Range<usize> {
        let start = self.globals().start;
        start..start + FIELD
    }

    pub fn hand_eye(&self) -> Range<usize> {
        let start = self.field().end;
        start..start + 6
    }

    pub fn clock(&self) -> usize {
        self.hand_eye().end
    }

    pub fn lag(&self) -> usize {
        self.clock() + 1
    }

    /// Clock offset and lag, as the base is read with them.
    pub fn offsets_s(&self, x: &[f64]) -> [f64; 2] {
        [x[self.clock()], x[self.lag()]]
    }

    /// The row of a frame at a moment (of the splines' time); `middle` is where the field's polynomial is centred.
    pub fn row(&self, t_s: f64, base: Isometry3<f64>, twist: Vector6<f64>, middle: &Vector3<f64>) -> Row {
        let p = (base.translation.vector - middle) / FIELD_LENGTH_M;
        let monomials = [1.0, p.x, p.y, p.z, p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.y * p.z, p.z * p.x];
        let world_from_base = base.rotation.to_rotation_matrix().into_inner();
        let knots = self.splines.map(|knots| knots.weights(t_s));
        Row { knots, monomials, base, world_from_base, twist }
    }

    /// The correction of one frame; `with_clock` adds what a change of tau and lag does to it (for steps, not for poses:
    /// there the base was read with them already).
    pub fn correction(&self, row: &Row, x: &[f64], with_clock: bool) -> Vector6<f64> {
        let mut sum = Vector6::zeros();
        for (which, (knot, weights)) in row.knots.iter().enumerate() {
            let first = self.spline(which).start;
            for (a, weight) in weights.iter().enumerate() {
                let at = first + 6 * (knot + a);
                (0..6).for_each(|i| sum[i] += weight * x[at + i]);
            }
        }
        let mut in_world = [Vector3::zeros(); 2];
        let field = &x[self.field()];
        for (coefficients, monomial) in field.chunks_exact(6).zip(row.monomials) {
            for i in 0..3 {
                in_world[0][i] += monomial * coefficients[i];
                in_world[1][i] += monomial * coefficients[3 + i];
            }
        }
        let in_body = in_world.map(|v| row.world_from_base.tr_mul(&v));
        let eta = &x[self.hand_eye()];
        for i in 0..3 {
            sum[i] += in_body[0][i] + eta[i];
            sum[3 + i] += in_body[1][i] + eta[3 + i];
        }
        if with_clock {
            sum += row.twist * x[self.clock()];
            (3..6).for_each(|i| sum[i] += row.twist[i] * x[self.lag()]);
        }
        sum
    }

    /// The transpose: adds one frame's force on its correction to the forces on the unknowns that are free.
    pub fn spread(&self, row: &Row, force: &Vector6<f64>, free: &Free, out: &mut [f64]) {
        for (which, (knot, weights)) in row.knots.iter().enumerate().filter(|(which, _)| free.splines[*which]) {
            let first = self.spline(which).start;
            for (a, weight) in weights.iter().enumerate() {
                let at = first + 6 * (knot + a);
                (0..6).for_each(|i| out[at + i] += weight * force[i]);
            }
        }
        self.spread_globally(row, force, free, &mut out[self.globals()]);
    }

    fn spread_globally(&self, row: &Row, force: &Vector6<f64>, free: &Free, out: &mut [f64]) {
        if free.field {
            let shift = row.world_from_base * force.fixed_rows::<3>(0);
            let turn = row.world_from_base * force.fixed_rows::<3>(3);
            for (coefficients, monomial) in out[..FIELD].chunks_exact_mut(6).zip(row.monomials) {
                for i in 0..3 {
                    coefficients[i] += monomial * shift[i];
                    coefficients[3 + i] += monomial * turn[i];
                }
            }
        }
        if free.hand_eye {
            (0..6).for_each(|i| out[FIELD + i] += force[i]);
        }
        if free.clock {
            out[FIELD + 6] += row.twist.dot(force);
        }
        if free.lag {
            out[FIELD + 7] += row.twist.fixed_rows::<3>(3).dot(&force.fixed_rows::<3>(3));
        }
    }

    /// The derivative of the correction by the globals that are free: one column each.
    pub fn global_columns(&self, row: &Row, free: &Free) -> Vec<[f64; GLOBALS]> {
        let column = |axis: usize| {
            let mut out = [0.0; GLOBALS];
            let mut force = Vector6::zeros();
            force[axis] = 1.0;
            self.spread_globally(row, &force, free, &mut out);
            out
        };
        (0..6).map(column).collect()
    }
}

impl Row {
    /// world_from_body after a correction: R = R_base exp(dr), p = p_base + R_base dt.
    pub fn corrected(&self, correction: &Vector6<f64>) -> Isometry3<f64> {
        let shift: Vector3<f64> = correction.fixed_rows::<3>(0).into();
        let turn = nalgebra::UnitQuaternion::new(correction.fixed_rows::<3>(3).into_owned());
        let translation = self.base.translation.vector + self.world_from_base * shift;
        Isometry3::from_parts(translation.into(), self.base.rotation * turn)
    }
}
