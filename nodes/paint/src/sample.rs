//! The estimates of each cell: a fair draw of a few from all that come, and their robust mean.
//!
//! The draw is weighted reservoir sampling (Efraimidis & Spirakis 2006, exponential keys): of all estimates those with
//! the smallest -ln(u) / weight stay, so it does not matter in which order the pictures come. u is a hash of the cell and
//! of the picture's stamp: same input, same draw.

use crate::config::SAMPLES_MAX;

/// One estimate of one cell. Light is kept as the square root in 16 bits: 0.4 % at a thousandth of the scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Infinite for an empty place.
    key: f32,
    radiance: [u16; 3],
    irradiance: u16,
    weight: u16,
}

const FULL: f32 = 64.0;

fn pack(value: f32) -> u16 {
    ((value / FULL).max(0.0).sqrt() * 65535.0).round().min(65535.0) as u16
}

fn unpack(value: u16) -> f32 {
    (f32::from(value) / 65535.0).powi(2) * FULL
}

impl Sample {
    /// No estimate.
    pub const EMPTY: Self = Self { key: f32::INFINITY, radiance: [0; 3], irradiance: 0, weight: 0 };

    /// An estimate: light from the cell, light from the lamp onto it, weight above 0, and a hash that decides the draw.
    pub fn new(radiance: [f32; 3], irradiance: f32, weight: f32, hash: u64) -> Self {
        // 24 bits, never 0.
        let uniform = ((hash >> 40) as f32 + 0.5) / (1u64 << 24) as f32;
        let weight = weight.clamp(1e-3, FULL);
        let key = -uniform.ln() / weight;
        Self { key, radiance: radiance.map(pack), irradiance: pack(irradiance), weight: pack(weight) }
    }

    /// True unless it is an empty place.
    pub fn is_some(&self) -> bool {
        self.key.is_finite()
    }

    /// Light from the cell.
    pub fn radiance(&self) -> [f32; 3] {
        self.radiance.map(unpack)
    }

    /// Light from the lamp onto the cell.
    pub fn irradiance(&self) -> f32 {
        unpack(self.irradiance)
    }
}

/// Puts an estimate among those of its cell, which stay in the order of their keys, if the draw likes it better than the
/// last.
pub fn offer(kept: &mut [Sample], sample: Sample) {
    let place = kept.partition_point(|other| other.key <= sample.key);
    if place < kept.len() {
        kept[place..].rotate_right(1);
        kept[place] = sample;
    }
}

/// Mixes the bits of a number (splitmix64, Steele et al. 2014).
pub fn mix(value: u64) -> u64 {
    let z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Outliers are farther from the median than this many robust standard deviations (Tukey's biweight).
const TUKEY: f32 = 4.0;
/// Estimates that agree to this share of the median are all good: gleams, shadows and neighbours' colours differ more.
const AGREED: f32 = 0.04;

/// Linear albedo of a cell, up to a gain: light from it by light onto it. The mean of all estimates, those far from their
/// median left out by degrees (so a gleam, a shadow or a stranger's colour does not count). `None` without estimates.
pub fn albedo(kept: &[Sample], ambient: &[f32; 3]) -> Option<[f32; 3]> {
    let mut values = [[0.0; 3]; SAMPLES_MAX];
    let mut weights = [0.0; SAMPLES_MAX];
    let count = kept.partition_point(Sample::is_some);
    // A full cell was drawn by weight, so its estimates already count by it.
    let drawn = count == kept.len();
    for (at, sample) in kept[..count].iter().enumerate() {
        let (radiance, irradiance) = (sample.radiance(), sample.irradiance());
        values[at] = std::array::from_fn(|c| radiance[c] / (irradiance + ambient[c]).max(1e-4));
        weights[at] = if drawn { 1.0 } else { unpack(sample.weight) };
    }
    robust_mean(&values[..count], &weights[..count])
}

fn robust_mean(values: &[[f32; 3]], weights: &[f32]) -> Option<[f32; 3]> {
    if values.is_empty() {
        return None;
    }
    let centre: [f32; 3] = std::array::from_fn(|c| median(values.iter().map(|v| v[c])));
    let distance = |v: &[f32; 3]| (0..3).map(|c| (v[c] - centre[c]).powi(2)).sum::<f32>().sqrt();
    let size = centre.iter().map(|c| c * c).sum::<f32>().sqrt();
    // 1.4826: a standard deviation from a median of absolute deviations.
    let sigma = (1.4826 * median(values.iter().map(distance))).max(AGREED * size).max(f32::MIN_POSITIVE);
    let mut sum = [0.0; 3];
    let mut total = 0.0;
    for (value, weight) in values.iter().zip(weights) {
        let share = 1.0 - (distance(value) / (TUKEY * sigma)).powi(2);
        let weight = weight * share.max(0.0).powi(2);
        total += weight;
        (0..3).for_each(|c| sum[c] += weight * value[c]);
    }
    Some(if total > 0.0 { sum.map(|s| s / total) } else { centre })
}

/// Of at most [`SAMPLES_MAX`] values; the mean of the middle two when they are even.
pub fn median(values: impl Iterator<Item = f32>) -> f32 {
    let mut sorted = [0.0; SAMPLES_MAX];
    let mut count = 0;
    for (place, value) in sorted.iter_mut().zip(values) {
        *place = value;
        count += 1;
    }
    let sorted = &mut sorted[..count];
    sorted.sort_unstable_by(f32::total_cmp);
    match count {
        0 => 0.0,
        _ => 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]),
    }
}
