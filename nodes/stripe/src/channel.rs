//! The laser's grey level of a pixel, for each layout of bytes.

use crate::ConfigError;
use std::ops::Range;
use wire::{Frame, PeaksPer, PixelFormat, YCbCr};

/// Full scale of a byte.
const FULL: f32 = 255.0;
/// Fixed-point weights have this many binary places, so that their sum over three bytes stays inside an i16.
const PLACES: u32 = 7;

/// The weighted sum of red, green and blue that shows the laser best.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LaserChannel {
    weights: [f32; 3],
    saturation: f32,
    /// What a clipped pixel stands for.
    full: f32,
}

/// One pixel of the laser channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    /// In grey levels; full scale when clipped.
    pub grey: f32,
    /// A channel that counts is clipped.
    pub clipped: bool,
}

/// The laser channel of whole rows in bytes, for the search: level = (sum of weight * byte + offset) >> 7.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Levels {
    format: PixelFormat,
    weights: [i16; 3],
    offset: i16,
    /// Levels in one grey level of the channel.
    pub per_grey: f32,
}

impl LaserChannel {
    pub(crate) fn new(weights: [f64; 3], saturation_level: u8) -> Result<Self, ConfigError> {
        let good = weights.iter().all(|w| w.abs() <= 16.0) && weights.iter().any(|w| *w > 1e-3);
        if !good {
            return Err(ConfigError::Weights(weights));
        }
        let weights = weights.map(|w| w as f32);
        let full = FULL * weights.iter().map(|w| w.max(0.0)).sum::<f32>();
        Ok(Self { weights, saturation: f32::from(saturation_level), full })
    }

    /// What the layout of a frame makes of the weights: factors of its three bytes. The constant that belongs to them is
    /// left out, because the search looks at differences alone.
    fn factors(&self, format: PixelFormat) -> [f32; 3] {
        let [r, g, b] = self.weights;
        match (format, format.ycbcr()) {
            (PixelFormat::Grey8, _) => [1.0, 0.0, 0.0],
            (_, None) => self.weights,
            (_, Some(ycbcr)) => {
                let [red, green, blue] = ycbcr.slopes();
                std::array::from_fn(|byte| r * red[byte] + g * green[byte] + b * blue[byte])
            }
        }
    }

    /// The search's levels: the range of the channel laid over 0..=255.
    pub(crate) fn levels(&self, format: PixelFormat) -> Levels {
        let factors = self.factors(format);
        let per_grey = 1.0 / factors.iter().map(|f| f.abs()).sum::<f32>();
        // Cut towards zero, so that no sum of products can leave an i16.
        let weights = factors.map(|f| (f * per_grey * (1 << PLACES) as f32) as i16);
        let offset = -255 * weights.iter().map(|w| w.min(&0)).sum::<i16>();
        Levels { format, weights, offset, per_grey }
    }

    /// The pixels `range` of a line (a row or a column) of a checked frame that holds them.
    pub(crate) fn read(
        &self,
        frame: &Frame,
        peaks_per: PeaksPer,
        line: usize,
        range: Range<usize>,
        out: &mut Vec<Sample>,
    ) {
        out.clear();
        let stride = frame.stride as usize;
        // Byte of the line's first pixel, and from one pixel to the next.
        let (start, step) = match (peaks_per, frame.format) {
            (PeaksPer::Row, PixelFormat::Grey8) => (line * stride, 1),
            (PeaksPer::Row, _) => (line * stride, 3),
            (PeaksPer::Column, PixelFormat::Grey8) => (line, stride),
            (PeaksPer::Column, _) => (3 * line, stride),
        };
        let pixels = || frame.data[start + range.start * step..].chunks(step).take(range.len());
        // A copy of its own keeps the weights in registers.
        let channel = *self;
        match frame.format {
            PixelFormat::Grey8 => out.extend(pixels().map(move |p| {
                let y = f32::from(p[0]);
                Sample { grey: y, clipped: y >= channel.saturation }
            })),
            PixelFormat::Rgb8 => out.extend(pixels().map(move |p| {
                let p = &p[..3];
                channel.weigh([f32::from(p[0]), f32::from(p[1]), f32::from(p[2])])
            })),
            PixelFormat::Yuyv => self.read_pairs(YCbCr::LIMITED, frame, peaks_per, line, range, out),
            PixelFormat::YuyvFull => self.read_pairs(YCbCr::FULL, frame, peaks_per, line, range, out),
        }
    }

    fn read_pairs(
        &self,
        ycbcr: YCbCr,
        frame: &Frame,
        peaks_per: PeaksPer,
        line: usize,
        range: Range<usize>,
        out: &mut Vec<Sample>,
    ) {
        out.extend(range.map(|i| {
            let (u, v) = if peaks_per == PeaksPer::Row { (i, line) } else { (line, i) };
            let at = v * frame.stride as usize + 4 * (u / 2);
            let p = &frame.data[at..at + 4];
            self.weigh(ycbcr.rgb([p[2 * (u % 2)], p[1], p[3]]))
        }));
    }

    #[inline]
    fn weigh(&self, rgb: [f32; 3]) -> Sample {
        let [wr, wg, wb] = self.weights;
        let clips = |w: f32, c: f32| (w > 0.0) & (c >= self.saturation);
        let clipped = clips(wr, rgb[0]) | clips(wg, rgb[1]) | clips(wb, rgb[2]);
        // A clipped pixel says only "at least so much"; a core bloomed to white must not look dark.
        let grey = if clipped { self.full } else { wr * rgb[0] + wg * rgb[1] + wb * rgb[2] };
        Sample { grey, clipped }
    }
}

/// A row's levels, to be compiled for each kind of vectors. (A struct: a closure would be compiled once, for the least.)
struct Fill<'a> {
    levels: &'a Levels,
    row: &'a [u8],
    out: &'a mut [u8],
}

impl pulp::NullaryFnOnce for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        match self.levels.format {
            PixelFormat::Rgb8 => self.levels.fill_rgb(self.row, self.out),
            _ => self.levels.fill_yuyv(self.row, self.out),
        }
    }
}

impl Levels {
    /// The levels of one row of a checked frame. Plain loops over fixed strides, which the compiler makes into vectors.
    pub(crate) fn fill(&self, arch: pulp::Arch, row: &[u8], out: &mut [u8]) {
        match self.format {
            PixelFormat::Grey8 => out.copy_from_slice(&row[..out.len()]),
            _ => arch.dispatch(Fill { levels: self, row, out }),
        }
    }

    #[inline(always)]
    fn fill_rgb(&self, row: &[u8], out: &mut [u8]) {
        let row = &row[..3 * out.len()];
        for (out, p) in out.iter_mut().zip(row.chunks_exact(3)) {
            *out = self.level(p[0], p[1], p[2]);
        }
    }

    #[inline(always)]
    fn fill_yuyv(&self, row: &[u8], out: &mut [u8]) {
        let (even, odd) = out.split_at_mut(out.len() / 2 * 2);
        let (pairs, rest) = row.split_at(2 * even.len());
        for (out, p) in even.chunks_exact_mut(2).zip(pairs.chunks_exact(4)) {
            out[0] = self.level(p[0], p[1], p[3]);
            out[1] = self.level(p[2], p[1], p[3]);
        }
        // A row of odd width ends with half a pair.
        if let ([last], [y, u, _, v, ..]) = (odd, rest) {
            *last = self.level(*y, *u, *v);
        }
    }

    #[inline(always)]
    fn level(&self, x: u8, y: u8, z: u8) -> u8 {
        let [a, b, c] = self.weights;
        let sum = a * i16::from(x) + b * i16::from(y) + c * i16::from(z) + self.offset;
        (sum >> PLACES).clamp(0, 255) as u8
    }
}
