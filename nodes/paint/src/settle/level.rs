//! A picture made smaller and smoother, to be compared with others by brightness.

use crate::Picture;
use nalgebra::Point2;

/// The picture at a fraction of its size: means over squares, then the 1-2-1 blur. A value is the light to the power of
/// 1 / 2.2, in which noise is about even and differences are as an eye sees them. Not a number where it is saturated.
#[derive(Debug, Clone, Default)]
pub struct Level {
    width: usize,
    height: usize,
    factor: f64,
    /// Of the pixels of a square, from its first.
    middle: f64,
    values: Vec<[f32; 3]>,
}

/// What a level shows at a place.
pub struct Shown {
    /// Red, green, blue.
    pub value: [f32; 3],
    /// Their slopes per pixel of the whole picture, along u and v.
    pub slope: [[f64; 2]; 3],
}

const ENCODING: f32 = 1.0 / 2.2;

/// A linear quantity as the values of a level are.
pub fn encoded(linear: f32) -> f32 {
    linear.powf(ENCODING)
}

impl Level {
    /// At 1 / `factor` of its size. What does not fill a square at the right and lower rim is left out.
    pub fn new(picture: &Picture, factor: usize, saturated_from: u8) -> Self {
        let mut value_of = picture.light_of_value().map(encoded);
        value_of[usize::from(saturated_from)..].fill(f32::NAN);
        let whole = picture.width as usize;
        let (width, height) = (whole / factor, picture.height as usize / factor);
        let mut values = vec![[0.0; 3]; width * height];
        // Of large squares every fourth pixel is enough.
        let stride = if factor >= 4 { 2 } else { 1 };
        let share = 1.0 / (factor.div_ceil(stride) as f32).powi(2);
        for (row, line) in values.chunks_exact_mut(width.max(1)).enumerate() {
            for from in (row * factor..(row + 1) * factor).step_by(stride) {
                let pixels = picture.pixels[from * whole..][..width * factor].chunks_exact(factor);
                for (value, pixels) in line.iter_mut().zip(pixels) {
                    for pixel in pixels.iter().step_by(stride) {
                        (0..3).for_each(|c| value[c] += share * value_of[usize::from(pixel[c])]);
                    }
                }
            }
        }
        let middle = 0.5 * ((factor - 1) / stride * stride) as f64;
        let mut level = Self { width, height, factor: factor as f64, middle, values };
        level.blur();
        level
    }

    /// 1-2-1 along rows, then along columns; at the rim a pixel is its own neighbour.
    fn blur(&mut self) {
        let (width, height) = (self.width, self.height);
        let mean =
            |a: &[f32; 3], b: &[f32; 3], c: &[f32; 3]| std::array::from_fn(|i| 0.25 * (a[i] + c[i]) + 0.5 * b[i]);
        let mut along = Vec::with_capacity(self.values.len());
        for line in self.values.chunks_exact(width.max(1)) {
            along.extend(
                (0..width).map(|at| mean(&line[at.saturating_sub(1)], &line[at], &line[(at + 1).min(width - 1)])),
            );
        }
        self.values.clear();
        for row in 0..height {
            let line = |row: usize| &along[row * width..(row + 1) * width];
            let (above, here, below) = (line(row.saturating_sub(1)), line(row), line((row + 1).min(height - 1)));
            self.values.extend((0..width).map(|at| mean(&above[at], &here[at], &below[at])));
        }
    }

    /// Between the values around a pixel of the whole picture; `None` beside it and near saturated pixels.
    pub fn at(&self, pixel: &Point2<f64>) -> Option<Shown> {
        let [x, y] = [pixel.x, pixel.y].map(|c| (c - self.middle) / self.factor);
        let inside = x >= 0.0 && y >= 0.0 && x + 1.0 < self.width as f64 && y + 1.0 < self.height as f64;
        if !inside {
            return None;
        }
        let (right, down) = (x.fract() as f32, y.fract() as f32);
        let at = y as usize * self.width + x as usize;
        let [a, b] = [self.values[at], self.values[at + 1]];
        let [c, d] = [self.values[at + self.width], self.values[at + self.width + 1]];
        let mut shown = Shown { value: [0.0; 3], slope: [[0.0; 2]; 3] };
        for i in 0..3 {
            let (upper, lower) = (a[i] + right * (b[i] - a[i]), c[i] + right * (d[i] - c[i]));
            shown.value[i] = upper + down * (lower - upper);
            let along_u = (1.0 - down) * (b[i] - a[i]) + down * (d[i] - c[i]);
            shown.slope[i] = [along_u, lower - upper].map(|slope| f64::from(slope) / self.factor);
        }
        shown.value.iter().all(|value| value.is_finite()).then_some(shown)
    }
}
