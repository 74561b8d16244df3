//! Synthetic pictures of a laser line whose true position is known, after reference/algorithms: a Gaussian line of
//! sigma 1.2-2.5 px and amplitude 60-150 over a textured background, with read noise 3, shot noise, and speckle as
//! correlated multiplicative noise (correlation sigma 1 px).

use wire::{Bulk, Frame, Header, LaserPlane, Light, PeaksPer, Phase, PixelFormat};

/// What the picture shows.
#[derive(Debug, Clone, Copy)]
pub struct Scene {
    pub width: usize,
    pub height: usize,
    pub speckle_contrast: f64,
    pub read_noise: f64,
    /// Multiplies the amplitude of the line.
    pub brightness: f64,
    pub seed: u64,
}

impl Default for Scene {
    fn default() -> Self {
        Self { width: 1280, height: 1024, speckle_contrast: 0.0, read_noise: 3.0, brightness: 1.0, seed: 1 }
    }
}

/// Grey levels of variance that each grey level of light brings.
const SHOT: f64 = 0.1;
/// Share of the laser's light that each channel sees.
const LASER_RGB: [f64; 3] = [1.0, 0.08, 0.03];
/// Tint of the room's light.
const AMBIENT_RGB: [f64; 3] = [1.0, 0.95, 0.85];

/// Deviates that are the same everywhere (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.uniform(), self.uniform());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }
}

/// The line of the true picture in row `v`: position, sigma, amplitude.
pub fn truth(scene: &Scene, v: usize) -> [f64; 3] {
    let (w, t) = (scene.width as f64, v as f64 / scene.height as f64);
    let step = match (t * 8.0) as usize {
        1 => 0.03 * w,
        4 => -0.05 * w,
        6 => 0.01 * w,
        _ => 0.0,
    };
    let position = w * (0.45 + 0.15 * t + 0.02 * (9.0 * t).sin()) + step;
    let sigma = 1.85 + 0.65 * (13.0 * t).sin();
    let amplitude = scene.brightness * (105.0 + 45.0 * (29.0 * t + 1.0).sin());
    [position, sigma, amplitude]
}

/// The picture; with `PeaksPer::Column` it is turned on its side, so that rows are columns.
pub fn rgb(scene: &Scene, peaks_per: PeaksPer) -> Frame {
    let mut random = Random(scene.seed);
    let (w, h) = (scene.width, scene.height);
    let speckle = speckle(scene, &mut random);
    let turned = peaks_per == PeaksPer::Column;
    let mut data = vec![0; 3 * w * h];
    for v in 0..h {
        let [position, sigma, amplitude] = truth(scene, v);
        for u in 0..w {
            let x = u as f64 - position;
            let line = if x.abs() > 6.0 * sigma { 0.0 } else { amplitude * over_pixel(x, sigma) };
            let laser = line * (1.0 + scene.speckle_contrast * speckle[v * w + u]).max(0.0);
            let ambient = texture(u as f64, v as f64);
            let at = 3 * if turned { u * h + v } else { v * w + u };
            for c in 0..3 {
                let light = laser * LASER_RGB[c] + ambient * AMBIENT_RGB[c];
                let noise = (scene.read_noise.powi(2) + SHOT * light).sqrt() * random.normal();
                data[at + c] = (light + noise).round().clamp(0.0, 255.0) as u8;
            }
        }
    }
    let (width, height) = if turned { (h, w) } else { (w, h) };
    frame(width, height, PixelFormat::Rgb8, data)
}

/// A frame lit by the laser, without padding.
pub fn frame(width: usize, height: usize, format: PixelFormat, data: Vec<u8>) -> Frame {
    Frame {
        header: Header { phase: Phase::Shape, scan: 7, seq: 3, stamp_nanos: 40_000_000, ..Header::default() },
        width: width as u32,
        height: height as u32,
        stride: format.row_bytes(width as u32) as u32,
        format,
        light: Light { laser: true, lamp: false },
        exposure_nanos: 4_000_000,
        gain: 1.0,
        gamma: 1.0,
        data: Bulk(data),
    }
}

/// A laser whose line is red on white light.
pub fn red_laser(peaks_per: PeaksPer) -> LaserPlane {
    LaserPlane { normal: [1.0, 0.0, 0.0], distance_m: 0.1, channel_weights: [1.0, -0.5, -0.5], peaks_per }
}

/// A Gaussian of height 1, averaged over a pixel (Simpson).
fn over_pixel(x: f64, sigma: f64) -> f64 {
    let g = |x: f64| (-0.5 * (x / sigma).powi(2)).exp();
    (g(x - 0.5) + 4.0 * g(x) + g(x + 0.5)) / 6.0
}

/// Waves and tiles of 15 to 65 grey levels.
fn texture(u: f64, v: f64) -> f64 {
    let waves = 10.0 * (0.11 * u + 0.05 * v).sin() + 6.0 * (0.31 * v - 0.23 * u).sin() + 4.0 * (0.7 * u).cos();
    let tiles = if ((u / 37.0) as i64 + (v / 53.0) as i64) % 2 == 0 { 5.0 } else { -5.0 };
    40.0 + waves + tiles
}

/// Unit variance, correlated over one pixel.
fn speckle(scene: &Scene, random: &mut Random) -> Vec<f64> {
    const REACH: usize = 3;
    let (w, h) = (scene.width, scene.height);
    if scene.speckle_contrast == 0.0 {
        return vec![0.0; w * h];
    }
    let kernel: Vec<f64> = (0..=2 * REACH).map(|i| (-0.5 * (i as f64 - REACH as f64).powi(2)).exp()).collect();
    let norm = kernel.iter().map(|k| k * k).sum::<f64>();
    let white: Vec<f64> = (0..w * h).map(|_| random.normal()).collect();
    let blur = |from: &[f64], step: usize, count: usize, at: usize, place: usize| -> f64 {
        (0..=2 * REACH)
            .map(|k| {
                let other = (place + k).saturating_sub(REACH).min(count - 1);
                kernel[k] * from[at - place * step + other * step]
            })
            .sum()
    };
    let across: Vec<f64> = (0..w * h).map(|i| blur(&white, 1, w, i, i % w)).collect();
    (0..w * h).map(|i| blur(&across, w, h, i, i / w) / norm).collect()
}
