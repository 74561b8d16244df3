//! From linear albedo to the bytes of the texture.

use crate::atlas::Atlas;
use rayon::prelude::*;

/// A cell that was seen.
pub const SEEN: u8 = 255;
/// A cell that was filled in from its neighbours.
pub const FILLED: u8 = 85;
/// Not a cell, or one without colour.
pub const NOTHING: u8 = 0;
/// Cells without colour.
pub const GREY: [u8; 3] = [128; 3];

/// Rings of texels around the charts that repeat their border, so that no sample between texels shows a seam.
const DILATED_TEXELS: usize = 2;

/// The sRGB byte of linear light in 0..1 (IEC 61966-2-1); what is brighter is cut.
pub fn srgb_byte(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

/// The gain that puts `percentile` of the brightest channels at `albedo`; 1 without colours.
pub fn white_gain(colours: &[Option<[f32; 3]>], percentile: f64, albedo: f64) -> f32 {
    let mut brightest: Vec<f32> = colours.iter().flatten().map(|c| c[0].max(c[1]).max(c[2])).collect();
    if brightest.is_empty() {
        return 1.0;
    }
    let at = ((brightest.len() - 1) as f64 * percentile).round() as usize;
    let (_, white, _) = brightest.select_nth_unstable_by(at, f32::total_cmp);
    if *white > 0.0 { albedo as f32 / *white } else { 1.0 }
}

/// The texture, row by row: red, green, blue and how it was coloured. Around the charts their border is repeated (as
/// [`NOTHING`]), and the rest has the mean colour, so that smaller copies of the texture keep their colour.
pub fn encode(atlas: &Atlas, cells: &[[u8; 4]]) -> Vec<[u8; 4]> {
    let mut texture = vec![None; atlas.number_at.len()];
    for (texel, cell) in atlas.texels.iter().zip(cells) {
        texture[texel.place as usize] = Some(*cell);
    }
    for _ in 0..DILATED_TEXELS {
        texture = dilated(&texture, atlas.width as usize);
    }
    let count = cells.len().max(1) as u64;
    let mean: [u8; 3] =
        std::array::from_fn(|c| (cells.iter().map(|cell| u64::from(cell[c])).sum::<u64>() / count) as u8);
    let around = [mean[0], mean[1], mean[2], NOTHING];
    texture.into_iter().map(|texel| texel.unwrap_or(around)).collect()
}

/// Each empty texel takes the mean of its neighbours.
fn dilated(texture: &[Option<[u8; 4]>], width: usize) -> Vec<Option<[u8; 4]>> {
    let height = texture.len() / width.max(1);
    let grown = |place: usize| {
        let (row, column) = (place / width, place % width);
        let (mut sum, mut count) = ([0; 3], 0);
        for near in row.saturating_sub(1)..(row + 2).min(height) {
            let line = &texture[near * width..(near + 1) * width];
            for texel in line[column.saturating_sub(1)..(column + 2).min(width)].iter().flatten() {
                (0..3).for_each(|c| sum[c] += u32::from(texel[c]));
                count += 1;
            }
        }
        (count > 0)
            .then(|| [sum[0] / count, sum[1] / count, sum[2] / count].map(|c| c as u8))
            .map(|[r, g, b]| [r, g, b, NOTHING])
    };
    (0..texture.len()).into_par_iter().map(|place| texture[place].or_else(|| grown(place))).collect()
}
