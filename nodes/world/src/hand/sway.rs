//! What a hand does without meaning to: sums of sines, so that any moment can be had in any order.

use crate::random::uniform;
use nalgebra::Vector3;
use std::f64::consts::TAU;

const WAVES: u64 = 5;

/// Smooth movement in a band of frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct Sway {
    waves: Vec<Wave>,
}

#[derive(Debug, Clone, PartialEq)]
struct Wave {
    frequency_hz: f64,
    amplitude: f64,
    phases: Vector3<f64>,
}

impl Sway {
    /// A vector whose root mean square length is `rms`, in whatever unit that has.
    pub fn new(rms: f64, [low_hz, high_hz]: [f64; 2], seed: u64) -> Self {
        let amplitude = rms * (2.0 / (3.0 * WAVES as f64)).sqrt();
        let waves = (0..WAVES).map(|i| {
            // One in each part of the band, so that it is always filled.
            let at = (i as f64 + uniform(seed, 4 * i)) / WAVES as f64;
            let phases = Vector3::from_fn(|axis, _| TAU * uniform(seed, 4 * i + 1 + axis as u64));
            Wave { frequency_hz: low_hz + (high_hz - low_hz) * at, amplitude, phases }
        });
        Self { waves: waves.collect() }
    }

    /// Its value at a moment.
    pub fn at(&self, t_s: f64) -> Vector3<f64> {
        let angle = |wave: &Wave| wave.phases.add_scalar(TAU * wave.frequency_hz * t_s);
        self.waves.iter().map(|wave| angle(wave).map(f64::sin) * wave.amplitude).sum()
    }

    /// The integral of its first component from time 0.
    pub fn integral_of_x(&self, t_s: f64) -> f64 {
        let primitive = |wave: &Wave, t: f64| {
            let rate = TAU * wave.frequency_hz;
            -wave.amplitude / rate * (wave.phases.x + rate * t).cos()
        };
        self.waves.iter().map(|wave| primitive(wave, t_s) - primitive(wave, 0.0)).sum()
    }
}
