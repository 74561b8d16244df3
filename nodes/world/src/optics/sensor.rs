//! From light to bytes: shot and read noise, gain, gamma, eight bits.

use super::random_field::{BLOCK, NormalTable};
use super::section::SensorSection;

/// The sensor with its tables.
#[derive(Debug, Clone)]
pub(super) struct Sensor {
    /// Electrons of full scale at gain 1.
    full_electrons: [f32; 3],
    /// Squared.
    read_variance: f32,
    /// Values of the response, by the exponent and first bits of the light's f32: finest where it is darkest.
    response: Vec<u8>,
}

/// Bits of the mantissa that the table tells apart.
const MANTISSA_BITS: u32 = 9;
const SHIFT: u32 = f32::MANTISSA_DIGITS - 1 - MANTISSA_BITS;
/// Darker than this (2^-18) is black at any gamma that is allowed to be.
const DARKEST: f32 = 1.0 / (1 << 18) as f32;

impl Sensor {
    pub fn new(section: &SensorSection) -> Self {
        let exponent = 1.0 / section.gamma;
        let entries = 1 + place(1.0);
        let response = (0..=entries).map(|entry| {
            let light = f64::from(f32::from_bits(DARKEST.to_bits() + (entry << SHIFT) + (1 << (SHIFT - 1)))).min(1.0);
            (255.0 * light.powf(exponent)).round() as u8
        });
        let mut response: Vec<u8> = response.collect();
        response[0] = 0;
        Self {
            full_electrons: section.sensitivity.map(|share| (share * section.full_well_electrons) as f32),
            read_variance: (section.read_noise_electrons * section.read_noise_electrons) as f32,
            response,
        }
    }

    /// One row: `light` is red, green and blue of the row in turn, `places` as long; `out` is interleaved.
    #[inline(always)]
    pub fn expose(&self, light: &[f32], gain: f32, noise: Noise, places: &mut [u32], out: &mut [u8]) {
        let width = light.len() / 3;
        for (channel, full) in self.full_electrons.iter().enumerate() {
            let (light, places) = (&light[channel * width..][..width], &mut places[channel * width..][..width]);
            let scale = gain / full;
            for (block, (light, places)) in light.chunks(BLOCK).zip(places.chunks_mut(BLOCK)).enumerate() {
                let random = noise.table.block(noise.key, noise.first_block + (channel << 16 | block) as u64);
                for ((place_out, light), random) in places.iter_mut().zip(light).zip(random) {
                    let electrons = full * if *light > 0.0 { *light } else { 0.0 };
                    let read = electrons + (electrons + self.read_variance).sqrt() * random;
                    *place_out = place(read * scale);
                }
            }
        }
        let (red, rest) = places.split_at(width);
        let (green, blue) = rest.split_at(width);
        for (((pixel, red), green), blue) in out.chunks_exact_mut(3).zip(red).zip(green).zip(blue) {
            pixel[0] = self.response[*red as usize];
            pixel[1] = self.response[*green as usize];
            pixel[2] = self.response[*blue as usize];
        }
    }
}

/// Whose random numbers a row takes.
#[derive(Clone, Copy)]
pub(super) struct Noise<'a> {
    pub table: &'a NormalTable,
    /// Hashed from seed and frame.
    pub key: u64,
    /// Of the row.
    pub first_block: u64,
}

/// The table's entry of some light.
#[inline(always)]
fn place(light: f32) -> u32 {
    // Written so that NaN is dark.
    let light = if light > DARKEST { light } else { DARKEST };
    let light = if light < 1.0 { light } else { 1.0 };
    (light.to_bits() - DARKEST.to_bits()) >> SHIFT
}
