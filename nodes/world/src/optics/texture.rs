//! Colour from a texture, in linear light.

use super::stage::linear;
use crate::Texture;
use wide::f32x4;

/// A texture in linear light: red, green, blue and nothing in whole numbers, 65535 is white. Kept as what is reckoned
/// with: turning them into floats took as long as the rest of a look.
#[derive(Debug, Clone)]
pub(super) struct LinearTexture {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 4]>,
}

impl LinearTexture {
    pub fn new(texture: &Texture) -> Self {
        let table: [f32; 256] = std::array::from_fn(|value| (linear(value as u8) * 65535.0).round());
        let pixel =
            |&[red, green, blue]: &[u8; 3]| [table[red as usize], table[green as usize], table[blue as usize], 0.0];
        Self { width: texture.width, height: texture.height, pixels: texture.rgb.iter().map(pixel).collect() }
    }

    /// How many of its pixels a step in texture coordinates passes, along the longer axis.
    pub fn pixels_along(&self, [u, v]: [f32; 2]) -> f32 {
        (u * self.width as f32).abs().max((v * self.height as f32).abs())
    }

    /// Bilinear between the four pixels around `uv`: red, green, blue and nothing. Beyond its edges the texture repeats.
    #[inline(always)]
    pub fn sample(&self, uv: [f32; 2]) -> f32x4 {
        let place = [uv[0] * self.width as f32 - 0.5, uv[1] * self.height as f32 - 0.5];
        let [column, row] = [floor(place[0]), floor(place[1])];
        let [u, v] = [place[0] - column as f32, place[1] - row as f32];
        let [a, b, c, d] = self.around(column, row).map(|place| f32x4::new(self.pixels[place]));
        let (above, below) = (a + (b - a) * u, c + (d - c) * u);
        (above + (below - above) * v) * (1.0 / 65535.0)
    }

    /// Where the pixels lie at a place and to the right of it, in its row and in the next; mostly none is beyond an edge.
    #[inline(always)]
    fn around(&self, column: i32, row: i32) -> [usize; 4] {
        let [left, above] = [column, row].map(|place| place as usize);
        if column >= 0 && row >= 0 && left + 1 < self.width && above + 1 < self.height {
            let start = above * self.width + left;
            return [start, start + 1, start + self.width, start + self.width + 1];
        }
        let wrap = |place: i32, size: usize| i64::from(place).rem_euclid(size as i64) as usize;
        let at = |row: i32, column: i32| wrap(row, self.height) * self.width + wrap(column, self.width);
        let [right, below] = [column.wrapping_add(1), row.wrapping_add(1)];
        [at(row, column), at(row, right), at(below, column), at(below, right)]
    }
}

/// f32::floor is a call where the processor may be an old one.
#[inline(always)]
fn floor(value: f32) -> i32 {
    let towards_zero = value as i32;
    towards_zero - i32::from(value < towards_zero as f32)
}

/// Texture coordinates within a triangle.
pub(super) fn blend(uv: [[f32; 2]; 3], weights: [f32; 3]) -> [f32; 2] {
    std::array::from_fn(|axis| (0..3).map(|i| weights[i] * uv[i][axis]).sum())
}
