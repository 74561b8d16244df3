//! Distortion of the magnetic field by the metal of a room: smooth in space, the same whenever the handset comes back.

use super::TrackerSection;
use crate::random::{normal3, uniform};
use geometry::METRES_PER_MM;
use nalgebra::{Point3, Vector3};
use std::f64::consts::TAU;

/// Plane waves in each field: enough to make it look the same from all sides.
const WAVES: u64 = 32;

/// Two random fields of plane waves, of one wavelength, in all directions: their covariance over a distance d is
/// sin(kd)/(kd), which is what was fitted to the real readings.
#[derive(Debug, Clone)]
pub struct Field {
    position: Vec<PlaneWave>,
    rotation: Vec<PlaneWave>,
    base: Point3<f64>,
    growth: f64,
}

#[derive(Debug, Clone)]
struct PlaneWave {
    wave_vector: Vector3<f64>,
    amplitude: Vector3<f64>,
    phase: f64,
}

impl Field {
    /// The field of one room: the seed chooses it.
    pub fn new(section: &TrackerSection, seed: u64) -> Self {
        let waves = |rms: f64, stream: u64| plane_waves(rms, section.field_wavelength_m, seed.wrapping_add(stream));
        Self {
            position: waves(section.field_position_mm * METRES_PER_MM, 0),
            rotation: waves(section.field_rotation_deg.to_radians(), 1),
            base: section.base_m.into(),
            growth: section.field_growth,
        }
    }

    /// Errors of the position (metres, in the world) and of the rotation (radians, about the axes of the body).
    pub fn at(&self, p_in_world: &Point3<f64>) -> [Vector3<f64>; 2] {
        let growth = (p_in_world - self.base).norm().powf(self.growth);
        [&self.position, &self.rotation].map(|waves| {
            let wave = |w: &PlaneWave| w.amplitude * (w.wave_vector.dot(&p_in_world.coords) + w.phase).sin();
            waves.iter().map(wave).sum::<Vector3<f64>>() * growth
        })
    }
}

fn plane_waves(rms: f64, wavelength_m: f64, seed: u64) -> Vec<PlaneWave> {
    if rms == 0.0 {
        return Vec::new();
    }
    // Each wave's amplitude has a random direction and the length that the root mean square needs.
    let amplitude = rms * (2.0 / WAVES as f64).sqrt();
    let direction = |index: u64| normal3(seed, index).normalize();
    let wave = |i: u64| PlaneWave {
        wave_vector: direction(2 * i) * (TAU / wavelength_m),
        amplitude: direction(2 * i + 1) * amplitude,
        phase: TAU * uniform(seed ^ 0xf1e1d, i),
    };
    (0..WAVES).map(wave).collect()
}
