//! The lens's blur: a Gaussian, integrated over each pixel.

/// Places within a pixel for which the weights are kept.
const STEPS: usize = 64;

/// The blur along one axis; the picture's is the product of two.
#[derive(Debug, Clone)]
pub(super) struct Psf {
    /// Pixels on each side that it reaches.
    pub radius: usize,
    taps: usize,
    /// For places -1/2..1/2 px beside a pixel's centre, the share of the light in each pixel from `-radius` to `radius`.
    table: Vec<f32>,
}

impl Psf {
    pub fn new(sigma_px: f64) -> Self {
        let radius = (3.3 * sigma_px).ceil() as usize;
        let taps = 2 * radius + 1;
        let mut table = Vec::with_capacity((STEPS + 1) * taps);
        for step in 0..=STEPS {
            let place = step as f64 / STEPS as f64 - 0.5;
            let below = |edge: f64| 0.5 * (1.0 + erf((edge - place) / (sigma_px * std::f64::consts::SQRT_2)));
            let first = -(radius as f64) - 0.5;
            let whole = below(radius as f64 + 0.5) - below(first);
            table.extend((0..taps).map(|tap| {
                let edge = first + tap as f64;
                ((below(edge + 1.0) - below(edge)) / whole) as f32
            }));
        }
        Self { radius, taps, table }
    }

    /// The weights of light that falls exactly on a pixel's centre.
    pub fn centred(&self) -> &[f32] {
        &self.table[STEPS / 2 * self.taps..][..self.taps]
    }

    /// For light at `place_px`: the pixel of the first weight, and the weights.
    pub fn at(&self, place_px: f32, weights: &mut [f32; MOST_TAPS]) -> isize {
        let nearest = (place_px + 0.5).floor();
        let step = (place_px - nearest + 0.5) * STEPS as f32;
        let row = (step as usize).min(STEPS - 1);
        let blend = step - row as f32;
        let (low, high) = self.table[row * self.taps..][..2 * self.taps].split_at(self.taps);
        for ((weight, low), high) in weights.iter_mut().zip(low).zip(high) {
            *weight = low + blend * (high - low);
        }
        nearest as isize - self.radius as isize
    }

    /// How many weights there are.
    pub fn taps(&self) -> usize {
        self.taps
    }
}

/// Weights of the widest blur (3 px).
pub(super) const MOST_TAPS: usize = 21;

/// The error function, to 1.5e-7 (Abramowitz and Stegun 1964, 7.1.26).
fn erf(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x.abs());
    let series = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    let sum = series.iter().rev().fold(0.0, |sum, a| (sum + a) * t);
    (1.0 - sum * (-x * x).exp()).copysign(x)
}
