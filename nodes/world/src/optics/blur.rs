//! The lens's blur over the whole picture, row by row: across first, then down over the rows around.

use super::psf::MOST_TAPS;

/// The rows that the blur down still needs, each three channels of `width`.
#[derive(Debug, Clone, Default)]
pub(super) struct BlurRows {
    rows: Vec<f32>,
    stride: usize,
    padded: Vec<f32>,
}

impl BlurRows {
    /// For pictures `width` wide.
    pub fn reset(&mut self, width: usize, taps: usize) {
        self.stride = 3 * width;
        self.rows.resize(taps * self.stride, 0.0);
    }

    /// Takes a row of light, blurred across. The picture's edge pixels go on beyond it.
    pub fn push(&mut self, row: usize, light: &[f32], weights: &[f32]) {
        let radius = weights.len() / 2;
        let width = self.stride / 3;
        let start = (row % weights.len()) * self.stride;
        let out = &mut self.rows[start..start + self.stride];
        for (channel, out) in light.chunks_exact(width).zip(out.chunks_exact_mut(width)) {
            self.padded.clear();
            self.padded.extend(std::iter::repeat_n(channel[0], radius));
            self.padded.extend_from_slice(channel);
            self.padded.extend(std::iter::repeat_n(channel[width - 1], radius));
            weigh(out, weights, |tap| &self.padded[tap..tap + width]);
        }
    }

    /// A row of the picture, `height` rows high; all rows that it needs must have been taken, and none too many.
    pub fn blurred(&self, row: usize, height: usize, weights: &[f32], out: &mut [f32]) {
        let radius = weights.len() / 2;
        weigh(out, weights, |tap| {
            let source = (row + tap).saturating_sub(radius).min(height - 1);
            &self.rows[(source % weights.len()) * self.stride..][..self.stride]
        });
    }
}

/// Values that are summed at a time, so that the sums stay in registers.
const LANES: usize = 16;

/// The sum of symmetric weights times sources, all as long as `out`.
fn weigh<'a>(out: &mut [f32], weights: &[f32], source: impl Fn(usize) -> &'a [f32]) {
    let radius = weights.len() / 2;
    let mut sources = [[&[] as &[f32]; 2]; MOST_TAPS / 2];
    let pairs = &mut sources[..radius];
    pairs.iter_mut().enumerate().for_each(|(tap, pair)| *pair = [source(tap), source(weights.len() - 1 - tap)]);
    let middle = source(radius);
    let mut start = 0;
    for out in out.chunks_mut(LANES) {
        let here = start..start + out.len();
        if out.len() == LANES {
            let mut sum: [f32; LANES] = std::array::from_fn(|i| weights[radius] * middle[here.clone()][i]);
            for ([before, behind], weight) in pairs.iter().zip(weights) {
                let (before, behind) = (&before[here.clone()], &behind[here.clone()]);
                for i in 0..LANES {
                    sum[i] += weight * (before[i] + behind[i]);
                }
            }
            out.copy_from_slice(&sum);
        } else {
            for (i, out) in here.clone().zip(out) {
                let beside: f32 = pairs.iter().zip(weights).map(|([a, b], weight)| weight * (a[i] + b[i])).sum();
                *out = weights[radius] * middle[i] + beside;
            }
        }
        start = here.end;
    }
}
