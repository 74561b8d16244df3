//! How much of the scatter along the stripe the noise of the pixels does not explain: the contrast of the speckle.

use crate::lateral::Link;
use std::ops::Range;

/// Fewer differences tell nothing.
const MIN_COUNT: usize = 32;
/// The median of the square of a normal deviate.
const MEDIAN_SQUARE: f32 = 0.454_936;
/// No surface has more: fully developed speckle has contrast 1.
const MAX_CONTRAST: f32 = 2.0;
/// Halvings of the interval: 2 / 2^12 is far below what the count can tell.
const HALVINGS: usize = 12;

/// The square of the contrast C for which half of the third differences d along the chains stay below the median of
/// their variance, noise + C^2 speckle. Third differences x0 - 3 x1 + 3 x2 - x3 of links `apart` lines from one another
/// see no position, slope or curvature of the surface; a median sees no steps. `None` when the chains are too short.
pub(crate) fn contrast_squared(
    links: &[Link],
    chains: &[Range<usize>],
    apart: usize,
    buffer: &mut Vec<[f32; 3]>,
) -> Option<f32> {
    buffer.clear();
    for chain in chains {
        let links = &links[chain.clone()];
        for i in 0..links.len().saturating_sub(3 * apart) {
            let four = [&links[i], &links[i + apart], &links[i + 2 * apart], &links[i + 3 * apart]];
            let sum = |f: fn(&Link) -> f32, weights: [f32; 4]| four.iter().zip(weights).map(|(l, w)| w * f(l)).sum();
            let d: f32 = sum(|l| l.position, [1.0, -3.0, 3.0, -1.0]);
            let squares = [1.0, 9.0, 9.0, 1.0];
            buffer.push([d * d, sum(|l| l.noise_variance, squares), sum(|l| l.speckle_variance, squares)]);
        }
    }
    if buffer.len() < MIN_COUNT {
        return None;
    }
    let too_small = |c2: f32| {
        let beyond = buffer.iter().filter(|[d2, noise, speckle]| *d2 > MEDIAN_SQUARE * (noise + c2 * speckle));
        2 * beyond.count() > buffer.len()
    };
    // In contrast, not in its square, so that small ones are told as finely as large ones.
    let (mut low, mut high) = (0.0, MAX_CONTRAST);
    for _ in 0..HALVINGS {
        let middle: f32 = 0.5 * (low + high);
        if too_small(middle * middle) { low = middle } else { high = middle }
    }
    Some(low * low)
}
