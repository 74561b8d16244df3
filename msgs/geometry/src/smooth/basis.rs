//! The uniform cubic B-spline (de Boor 1978): four control points at a time, weighted by a polynomial of the place
//! between two knots.

use nalgebra::SVector;

/// A moment on the grid of knots, which are whole multiples of the spacing since the epoch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// The knot at or before the moment; the control points `knot .. knot + 4` act there.
    pub knot: i64,
    /// How far it is to the next knot, 0..1.
    pub share: f64,
}

impl Place {
    pub(super) fn of(stamp_nanos: i64, knot_nanos: i64) -> Self {
        let share = stamp_nanos.rem_euclid(knot_nanos) as f64 / knot_nanos as f64;
        Self { knot: stamp_nanos.div_euclid(knot_nanos), share }
    }

    /// How much each of the four control points counts.
    pub(super) fn weights(&self) -> [f64; 4] {
        let (u, v) = (self.share, 1.0 - self.share);
        let (u2, u3) = (u * u, u * u * u);
        [v * v * v / 6.0, (3.0 * u3 - 6.0 * u2 + 4.0) / 6.0, (-3.0 * u3 + 3.0 * u2 + 3.0 * u + 1.0) / 6.0, u3 / 6.0]
    }

    /// The derivative of the weights by the place in units of knots.
    pub(super) fn slopes(&self) -> [f64; 4] {
        let (u, v) = (self.share, 1.0 - self.share);
        [-0.5 * v * v, 1.5 * u * u - 2.0 * u, -1.5 * u * u + u + 0.5, 0.5 * u * u]
    }
}

/// The sum of four weighted control points.
pub(super) fn blend<const D: usize>(weights: &[f64; 4], controls: &[SVector<f64, D>]) -> SVector<f64, D> {
    weights.iter().zip(controls).fold(SVector::zeros(), |sum, (weight, control)| sum + control * *weight)
}
