//! Tables of random numbers, entered at places that are hashed from (seed, frame, pixel): a picture takes millions.

use super::psf::Psf;
use crate::random::{normal, word};

/// Normal numbers, mean 0 and standard deviation 1.
#[derive(Debug, Clone)]
pub(super) struct NormalTable(Vec<f32>);

/// Pixels that share one place in the table.
pub(super) const BLOCK: usize = 64;
const ENTRIES: usize = 1 << 16;

impl NormalTable {
    pub fn new(seed: u64) -> Self {
        let mut table: Vec<f32> = (0..ENTRIES + BLOCK).map(|i| normal(seed, i as u64) as f32).collect();
        standardise(&mut table);
        Self(table)
    }

    /// The numbers for one block of pixels.
    pub fn block(&self, frame_key: u64, block: u64) -> &[f32] {
        let start = word(frame_key, block) as usize % ENTRIES;
        &self.0[start..start + BLOCK]
    }
}

/// Speckle: normal numbers that are alike over about a pixel, on a torus that each frame enters somewhere else. What the
/// lens leaves of the laser's interference moves with every move of the hand.
#[derive(Debug, Clone)]
pub(super) struct SpeckleField(Vec<f32>);

/// Pixels on a side.
const SIDE: usize = 512;
/// Standard deviation of the grains' blur.
const GRAIN_SIGMA_PX: f64 = 0.7;

impl SpeckleField {
    pub fn new(seed: u64) -> Self {
        let white: Vec<f32> = (0..SIDE * SIDE).map(|i| normal(seed, i as u64) as f32).collect();
        let psf = Psf::new(GRAIN_SIGMA_PX);
        let blurred = |from: &[f32], step: [usize; 2]| -> Vec<f32> {
            let radius = psf.radius;
            let at = |i: usize, tap: usize| {
                let place = |x: usize, step: usize| (x + SIDE + step * tap - step * radius) % SIDE;
                from[place(i / SIDE, step[0]) * SIDE + place(i % SIDE, step[1])]
            };
            let weights = psf.centred();
            (0..SIDE * SIDE).map(|i| weights.iter().enumerate().map(|(tap, w)| w * at(i, tap)).sum()).collect()
        };
        let mut field = blurred(&blurred(&white, [0, 1]), [1, 0]);
        standardise(&mut field);
        Self(field)
    }

    /// Where a frame enters.
    pub fn entry(frame_key: u64) -> [usize; 2] {
        let place = word(frame_key, u64::MAX) as usize;
        [place % SIDE, (place / SIDE) % SIDE]
    }

    /// The number at a pixel.
    pub fn at(&self, [left, top]: [usize; 2], column: usize, row: usize) -> f32 {
        self.0[(row + top) % SIDE * SIDE + (column + left) % SIDE]
    }
}

/// Mean 0 and standard deviation 1, exactly.
fn standardise(values: &mut [f32]) {
    let count = values.len() as f64;
    let mean = values.iter().map(|x| f64::from(*x)).sum::<f64>() / count;
    let variance = values.iter().map(|x| (f64::from(*x) - mean).powi(2)).sum::<f64>() / count;
    let scale = variance.sqrt().recip();
    values.iter_mut().for_each(|x| *x = ((f64::from(*x) - mean) * scale) as f32);
}
