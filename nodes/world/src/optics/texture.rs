//! Colour from a texture, in linear light.

use super::stage::linear;
use crate::Texture;

/// A texture in linear light: red, green, blue and nothing, 65535 is white.
#[derive(Debug, Clone)]
pub(super) struct LinearTexture {
    width: usize,
    height: usize,
    pixels: Vec<[u16; 4]>,
}

impl LinearTexture {
    pub fn new(texture: &Texture) -> Self {
        let table: [u16; 256] = std::array::from_fn(|value| (linear(value as u8) * 65535.0).round() as u16);
        let pixel =
            |&[red, green, blue]: &[u8; 3]| [table[red as usize], table[green as usize], table[blue as usize], 0];
        Self { width: texture.width, height: texture.height, pixels: texture.rgb.iter().map(pixel).collect() }
    }

    /// How many of its pixels a step in texture coordinates passes, along the longer axis.
    pub fn pixels_along(&self, [u, v]: [f32; 2]) -> f32 {
        (u * self.width as f32).abs().max((v * self.height as f32).abs())
    }

    /// Bilinear between the four pixels around `uv`; beyond its edges the texture repeats.
    #[inline]
    pub fn sample(&self, uv: [f32; 2]) -> [f32; 3] {
        let place = [uv[0] * self.width as f32 - 0.5, uv[1] * self.height as f32 - 0.5];
        let [column, row] = [floor(place[0]), floor(place[1])];
        let [u, v] = [place[0] - column as f32, place[1] - row as f32];
        let [left, right] = [wrap(column, self.width), wrap(column.wrapping_add(1), self.width)];
        let [above, below] = [wrap(row, self.height), wrap(row.wrapping_add(1), self.height)];
        let [above, below] = [above * self.width, below * self.width];
        let at = |pixel: usize| self.pixels[pixel].map(f32::from);
        let (a, b, c, d) = (at(above + left), at(above + right), at(below + left), at(below + right));
        let mut colour = [0.0; 4];
        for k in 0..4 {
            let (above, below) = (a[k] + u * (b[k] - a[k]), c[k] + u * (d[k] - c[k]));
            colour[k] = (above + v * (below - above)) * (1.0 / 65535.0);
        }
        [colour[0], colour[1], colour[2]]
    }
}

/// f32::floor is a call where the processor may be an old one.
fn floor(value: f32) -> i32 {
    let towards_zero = value as i32;
    towards_zero - i32::from(value < towards_zero as f32)
}

/// Within 0..size; mostly it is already.
fn wrap(place: i32, size: usize) -> usize {
    let inside = place as usize;
    if place >= 0 && inside < size { inside } else { i64::from(place).rem_euclid(size as i64) as usize }
}

/// Texture coordinates within a triangle.
pub(super) fn blend(uv: [[f32; 2]; 3], weights: [f32; 3]) -> [f32; 2] {
    std::array::from_fn(|axis| (0..3).map(|i| weights[i] * uv[i][axis]).sum())
}
