//! Uniform cubic B-splines in time (de Boor 1978).

/// Where the knots of a spline are; it has `count` control points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Knots {
    pub start_s: f64,
    pub step_s: f64,
    pub count: usize,
}

impl Knots {
    /// Knots about `step_s` apart over a span of time.
    pub fn over(start_s: f64, end_s: f64, step_s: f64) -> Self {
        let pieces = ((end_s - start_s).max(0.0) / step_s).floor() as usize + 1;
        Self { start_s, step_s, count: pieces + 3 }
    }

    /// The first of the four control points that reach a moment, and their weights. Beyond its ends the spline goes on
    /// as at the end.
    pub fn weights(&self, t_s: f64) -> (usize, [f64; 4]) {
        let at = ((t_s - self.start_s) / self.step_s).clamp(0.0, (self.count - 3) as f64);
        let first = (at.floor() as usize).min(self.count - 4);
        let u = at - first as f64;
        let (u2, u3, v) = (u * u, u * u * u, 1.0 - u);
        let weights =
            [v * v * v, 3.0 * u3 - 6.0 * u2 + 4.0, -3.0 * u3 + 3.0 * u2 + 3.0 * u + 1.0, u3].map(|weight| weight / 6.0);
        (first, weights)
    }
}
