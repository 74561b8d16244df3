//! Symmetric matrices with a narrow band: product, Cholesky factor, solution, and the band of the inverse.

/// The lower band, row by row: `at(i, i - d)` for `d` up to the half bandwidth.
#[derive(Debug, Clone)]
pub(crate) struct Banded {
    pub size: usize,
    /// Entries of a row: the diagonal and those before it.
    width: usize,
    /// Row `i` holds column `i - width + 1 ..= i`, so its last entry is the diagonal.
    rows: Vec<f64>,
}

impl Banded {
    pub fn zeros(size: usize, half_bandwidth: usize) -> Self {
        let width = half_bandwidth + 1;
        Self { size, width, rows: vec![0.0; size * width] }
    }

    /// Adds to an entry of the lower triangle, within the band.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        self.rows[row * self.width + self.width - 1 + column - row] += value;
    }

    /// An entry of the lower triangle, within the band.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.rows[row * self.width + self.width - 1 + column - row]
    }

    pub fn half_bandwidth(&self) -> usize {
        self.width - 1
    }

    fn row(&self, row: usize) -> &[f64] {
        &self.rows[row * self.width..(row + 1) * self.width]
    }

    pub fn scaled(mut self, factor: f64) -> Self {
        self.rows.iter_mut().for_each(|value| *value *= factor);
        self
    }

    /// Scales the diagonal: Levenberg and Marquardt's damping.
    pub fn damp(&mut self, share: f64) {
        for row in 0..self.size {
            self.rows[row * self.width + self.width - 1] *= 1.0 + share;
        }
    }

    /// L with L L^T = A; a pivot that is not positive is made 1, which leaves its unknown alone.
    pub fn factor(mut self) -> Factor {
        let width = self.width;
        for i in 0..self.size {
            let first = (i + 1).saturating_sub(width);
            for j in first..=i {
                let (before, rest) = self.rows.split_at_mut(i * width);
                let row_i = &rest[..width];
                let from = first.max((j + 1).saturating_sub(width));
                // Columns from..j of both rows lie side by side.
                let dot = if j < i {
                    let row_j = &before[j * width..(j + 1) * width];
                    dot(&row_i[width - 1 + from - i..width - 1 + j - i], &row_j[width - 1 + from - j..width - 1])
                } else {
                    let own = &row_i[width - 1 + from - i..width - 1];
                    dot(own, own)
                };
                let value = row_i[width - 1 + j - i] - dot;
                rest[width - 1 + j - i] = if j < i {
                    value / before[j * width + width - 1]
                } else if value > 0.0 {
                    value.sqrt()
                } else {
                    1.0
                };
            }
        }
        Factor(self)
    }
}

/// A Cholesky factor within the band.
#[derive(Debug, Clone)]
pub(crate) struct Factor(Banded);

impl Factor {
    /// L v.
    pub fn product(&self, v: &[f64]) -> Vec<f64> {
        let width = self.0.width;
        let row = |i: usize| {
            let first = (i + 1).saturating_sub(width);
            dot(&self.0.row(i)[width - 1 + first - i..], &v[first..=i])
        };
        (0..self.0.size).map(row).collect()
    }

    /// Overwrites `b` with the solution of L L^T x = b.
    pub fn solve(&self, b: &mut [f64]) {
        let (size, width) = (self.0.size, self.0.width);
        for i in 0..size {
            let first = (i + 1).saturating_sub(width);
            let row = self.0.row(i);
            let sum = dot(&row[width - 1 + first - i..width - 1], &b[first..i]);
            b[i] = (b[i] - sum) / row[width - 1];
        }
        for i in (0..size).rev() {
            let first = (i + 1).saturating_sub(width);
            let row = self.0.row(i);
            let value = b[i] / row[width - 1];
            b[i] = value;
            for (target, l) in b[first..i].iter_mut().zip(&row[width - 1 + first - i..width - 1]) {
                *target -= l * value;
            }
        }
    }

    /// The band of the inverse (Takahashi, Fagan, Chin 1973): Z = D^-1 L^-1 + (I - U) Z, from the last row upwards.
    pub fn inverse_band(&self) -> Banded {
        let (size, width) = (self.0.size, self.0.width);
        let mut inverse = Banded::zeros(size, width - 1);
        for j in (0..size).rev() {
            let last = (j + width - 1).min(size - 1);
            let pivot = self.0.at(j, j);
            let below: Vec<f64> = (j + 1..=last).map(|k| self.0.at(k, j) / pivot).collect();
            for i in (j + 1..=last).rev() {
                let sum: f64 = (j + 1..=last).zip(&below).map(|(k, l)| l * inverse.at(i.max(k), i.min(k))).sum();
                inverse.add(i, j, -sum);
            }
            let sum: f64 = (j + 1..=last).zip(&below).map(|(k, l)| l * inverse.at(k, j)).sum();
            inverse.add(j, j, 1.0 / (pivot * pivot) - sum);
        }
        inverse
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Four sums side by side, in a fixed order: the compiler may not reorder floats by itself.
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a4.zip(b4) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    sums[0] + sums[1] + (sums[2] + sums[3]) + rest
}
