//! The lens's blur over the whole picture, row by row: across first, then down over the rows around.

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

    /// Takes a row of light, three channels that each have some room behind them, blurred across. The picture's edge
    /// pixels go on beyond it.
    #[inline(always)]
    pub fn push(&mut self, row: usize, light: &[f32], weights: &[f32]) {
        let radius = weights.len() / 2;
        let width = self.stride / 3;
        let start = (row % weights.len()) * self.stride;
        let out = &mut self.rows[start..start + self.stride];
        for (channel, out) in light.chunks_exact(light.len() / 3).zip(out.chunks_exact_mut(width)) {
            let channel = &channel[..width];
            self.padded.clear();
            self.padded.extend(std::iter::repeat_n(channel[0], radius));
            self.padded.extend_from_slice(channel);
            self.padded.extend(std::iter::repeat_n(channel[width - 1], radius));
            weigh(out, weights, |tap| &self.padded[tap..tap + width]);
        }
    }

    /// A row of the picture, `height` rows high; all rows that it needs must have been taken, and none too many.
    #[inline(always)]
    pub fn blurred(&self, row: usize, height: usize, weights: &[f32], out: &mut [f32]) {
        let radius = weights.len() / 2;
        weigh(out, weights, |tap| {
            let source = (row + tap).saturating_sub(radius).min(height - 1);
            &self.rows[(source % weights.len()) * self.stride..][..self.stride]
        });
    }
}

/// Pairs of sources that are added in one go.
const TOGETHER: usize = 3;

/// The sum of symmetric weights times sources, all as long as `out`.
#[inline(always)]
fn weigh<'a>(out: &mut [f32], weights: &[f32], source: impl Fn(usize) -> &'a [f32]) {
    let (radius, length) = (weights.len() / 2, out.len());
    let source = |tap: usize| &source(tap)[..length];
    out.iter_mut().zip(source(radius)).for_each(|(out, middle)| *out = weights[radius] * middle);
    for first in (0..radius).step_by(TOGETHER) {
        // Beyond the last pair the middle is added with no weight.
        let tap = |k: usize| (first + k).min(radius);
        let share: [f32; TOGETHER] = [0, 1, 2].map(|k| if first + k < radius { weights[first + k] } else { 0.0 });
        let [a, b, c] = [0, 1, 2].map(|k| [source(tap(k)), source(weights.len() - 1 - tap(k))]);
        for i in 0..length {
            let sum = out[i] + share[0] * (a[0][i] + a[1][i]);
            out[i] = sum + share[1] * (b[0][i] + b[1][i]) + share[2] * (c[0][i] + c[1][i]);
        }
    }
}
