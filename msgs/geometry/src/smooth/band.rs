//! Symmetric matrices with three diagonals on either side of the main one: all that the equations of a cubic spline
//! have, so that everything here is linear in their size.

use nalgebra::SVector;

/// Row i holds the elements (i, i), (i, i-1), (i, i-2), (i, i-3).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Band(Vec<[f64; 4]>);

/// L D L' with ones on the diagonal of L; the inverse of D is kept at place 0 of each row, for divisions are slow.
pub(super) struct Factor(Vec<[f64; 4]>);

/// A pivot that lost so many digits says that the readings do not hold all control points.
const LEAST_PIVOT: f64 = 1e-14;

impl Band {
    pub(super) fn zeros(size: usize) -> Self {
        Self(vec![[0.0; 4]; size])
    }

    /// Adds weight b b', b being four elements from `first` on.
    pub(super) fn add_outer(&mut self, first: usize, b: &[f64; 4], weight: f64) {
        for (i, row) in self.0[first..first + 4].iter_mut().enumerate() {
            for back in 0..=i {
                row[back] += weight * b[i] * b[i - back];
            }
        }
    }

    /// Adds lambda times the sum of squared third differences.
    pub(super) fn add_third_differences(&mut self, lambda: f64) {
        for first in 0..self.0.len().saturating_sub(3) {
            self.add_outer(first, &[-1.0, 3.0, -3.0, 1.0], lambda);
        }
    }

    /// b' M b for four elements from `first` on.
    pub(super) fn quadratic(&self, first: usize, b: &[f64; 4]) -> f64 {
        let mut sum = 0.0;
        for (i, row) in self.0[first..first + 4].iter().enumerate() {
            sum += row[0] * b[i] * b[i];
            for back in 1..=i {
                sum += 2.0 * row[back] * b[i] * b[i - back];
            }
        }
        sum
    }

    /// `None` when the matrix is not positive definite.
    pub(super) fn factor(mut self) -> Option<Factor> {
        let rows = &mut self.0;
        for i in 0..rows.len() {
            let diagonal = rows[i][0];
            for back in (1..=i.min(3)).rev() {
                let j = i - back;
                // L(i, k) D(k) stands in row i until the row is done; L(j, k) is final.
                let known: f64 = (back + 1..=i.min(3)).map(|far| rows[i][far] * rows[j][far - back]).sum();
                rows[i][back] -= known;
            }
            let mut pivot = diagonal;
            for back in 1..=i.min(3) {
                let scaled = rows[i][back] * rows[i - back][0];
                pivot -= scaled * rows[i][back];
                rows[i][back] = scaled;
            }
            if pivot.is_nan() || pivot <= LEAST_PIVOT * diagonal {
                return None;
            }
            rows[i][0] = 1.0 / pivot;
        }
        Some(Factor(self.0))
    }
}

impl Factor {
    /// Turns the right side into the solution.
    pub(super) fn solve<const D: usize>(&self, x: &mut [SVector<f64, D>]) {
        let rows = &self.0;
        for i in 0..rows.len() {
            for back in 1..=i.min(3) {
                let known = x[i - back] * rows[i][back];
                x[i] -= known;
            }
        }
        for i in (0..rows.len()).rev() {
            x[i] *= rows[i][0];
            for ahead in 1..=(rows.len() - 1 - i).min(3) {
                let known = x[i + ahead] * rows[i + ahead][ahead];
                x[i] -= known;
            }
        }
    }

    /// The inverse, as far as it lies within the band (Takahashi, Fagan and Chen 1973).
    pub(super) fn inverse(&self) -> Band {
        let (l, mut z) = (&self.0, Band::zeros(self.0.len()));
        for i in (0..l.len()).rev() {
            let reach = (l.len() - 1 - i).min(3);
            for column in (0..=reach).rev() {
                let mut value = if column == 0 { l[i][0] } else { 0.0 };
                for k in 1..=reach {
                    let (low, high) = (k.min(column), k.max(column));
                    value -= l[i + k][k] * z.0[i + high][high - low];
                }
                z.0[i + column][column] = value;
            }
        }
        z
    }
}
