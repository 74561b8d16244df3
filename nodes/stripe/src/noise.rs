//! How noisy a picture is, from the picture itself.

use crate::channel::Levels;
use wire::Frame;

/// So many rows, spread over the picture, are enough: 20,000 differences give the median within one per cent.
const ROWS: usize = 16;
/// Second differences of bytes stay below 4 * 255.
const BINS: usize = 1024;

/// Standard deviation of a pixel, in levels: the median of |x - 2y + z| along rows, which neither the stripe nor a slow
/// texture moves (0.6745 is the median of |z| for z ~ N(0, 1), and the difference has 1 + 4 + 1 times its variance).
pub(crate) fn sigma_levels(arch: pulp::Arch, frame: &Frame, levels: &Levels, line: &mut [u8]) -> f32 {
    let mut histogram = [0u32; BINS];
    let height = frame.height as usize;
    let step = height.div_ceil(ROWS).max(1);
    for v in (step / 2..height).step_by(step) {
        levels.fill(arch, &frame.data[v * frame.stride as usize..], line);
        for x in line.windows(3) {
            let second = i32::from(x[0]) - 2 * i32::from(x[1]) + i32::from(x[2]);
            histogram[second.unsigned_abs() as usize % BINS] += 1;
        }
    }
    median(&histogram) / (0.6745 * 6f32.sqrt())
}

/// The median of whole numbers, each spread evenly over a bin of width 1 (bin 0, of width one half, counts both signs).
fn median(histogram: &[u32]) -> f32 {
    let half = histogram.iter().sum::<u32>() as f32 / 2.0;
    let mut below = 0.0;
    for (value, &count) in histogram.iter().enumerate() {
        let count = count as f32;
        if below + count >= half && count > 0.0 {
            let (low, width) = if value == 0 { (0.0, 0.5) } else { (value as f32 - 0.5, 1.0) };
            return low + width * (half - below) / count;
        }
        below += count;
    }
    0.0
}
