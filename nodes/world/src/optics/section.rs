//! `[simulation.optics]` of a rig file.

use super::OpticsError;
use serde::Deserialize;

/// Numbers of light, lens and sensor. A signal of 1 is the sensor's full scale at gain 1.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OpticsSection {
    /// Frames a second; 25.
    pub rate_hz: f64,
    /// How long the shutter is open; 2000. The picture is that of its middle: there is no motion blur.
    pub exposure_us: f64,
    /// In phase `both`, every so many frames the lamp lights instead of the laser; 6.
    pub lamp_every: u64,
    /// Standard deviation of the lens's blur; 0.9.
    pub psf_sigma_px: f64,
    /// How much of the natural fall-off towards the corners (cos⁴) is there: 0 none, 1 all of it, up to 2; 1.
    pub vignetting: f64,
    /// The line laser.
    pub laser: LaserLightSection,
    /// The lamp beside the lens.
    pub lamp: LampSection,
    /// The picture's sensor.
    pub sensor: SensorSection,
    /// Automatic gain.
    pub gain: GainSection,
}

/// `[simulation.optics.laser]`: a fan in the rig's sheet (paper, section 3).
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LaserLightSection {
    /// Where the fan leaves, in the camera's frame (moved onto the sheet). Left out, it is where the sheet passes beside
    /// the lens.
    pub source_mm: Option<[f64; 3]>,
    /// Length of the line; 120 ...
    pub line_length_mm: f64,
    /// ... at this distance; 200.
    pub line_distance_mm: f64,
    /// Thickness of the sheet, the full width at half of its maximum; 0.1. The same at all distances.
    pub thickness_mm: f64,
    /// Light at the ends of the line beside that in the middle; 0.9.
    pub end_level: f64,
    /// Red signal of a white surface square to the sheet at `line_distance_mm`, at the line's ridge, before the blur of
    /// the lens; 2.
    pub level: f64,
    /// What red, green and blue make of 635 nm; 1, 0.06, 0.02.
    pub response: [f64; 3],
    /// Contrast of the speckle (standard deviation by mean, correlated over about 1 px), on the laser's light alone; 0.1.
    pub speckle_contrast: f64,
}

/// `[simulation.optics.lamp]`: a small white source; inverse square and cosine.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LampSection {
    /// In the camera's frame; 25, -15, 0.
    pub position_mm: [f64; 3],
    /// Signal of a white surface square to the lamp at 200 mm; 0.6. The scene's ambient light is in units of it.
    pub level: f64,
}

/// `[simulation.optics.sensor]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SensorSection {
    /// Electrons of full scale at gain 1, in a channel of sensitivity 1; 12000. Their square root is the shot noise.
    pub full_well_electrons: f64,
    /// Noise of reading, rms; 8.
    pub read_noise_electrons: f64,
    /// Share of its electrons that each channel gathers; white balance makes it up, with its noise; 0.9, 1, 0.45 (paper,
    /// section 6: the blue channel is considerably less sensitive and noisier).
    pub sensitivity: [f64; 3],
    /// value = 255 (light)^(1/gamma); 2.2.
    pub gamma: f64,
}

/// `[simulation.optics.gain]`: the brightest parts of each picture (of the line, when the laser is on) are brought to
/// `target`, before any noise is added.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GainSection {
    /// Otherwise the gain is `lowest`; true.
    pub automatic: bool,
    /// Linear; 1.
    pub lowest: f64,
    /// Linear; 8.
    pub highest: f64,
    /// Linear, of full scale; 0.7.
    pub target: f64,
}

impl Default for OpticsSection {
    fn default() -> Self {
        Self {
            rate_hz: 25.0,
            exposure_us: 2000.0,
            lamp_every: 6,
            psf_sigma_px: 0.9,
            vignetting: 1.0,
            laser: LaserLightSection::default(),
            lamp: LampSection::default(),
            sensor: SensorSection::default(),
            gain: GainSection::default(),
        }
    }
}

impl Default for LaserLightSection {
    fn default() -> Self {
        Self {
            source_mm: None,
            line_length_mm: 120.0,
            line_distance_mm: 200.0,
            thickness_mm: 0.1,
            end_level: 0.9,
            level: 2.0,
            response: [1.0, 0.06, 0.02],
            speckle_contrast: 0.1,
        }
    }
}

impl Default for LampSection {
    fn default() -> Self {
        Self { position_mm: [25.0, -15.0, 0.0], level: 0.6 }
    }
}

impl Default for SensorSection {
    fn default() -> Self {
        Self { full_well_electrons: 12_000.0, read_noise_electrons: 8.0, sensitivity: [0.9, 1.0, 0.45], gamma: 2.2 }
    }
}

impl Default for GainSection {
    fn default() -> Self {
        Self { automatic: true, lowest: 1.0, highest: 8.0, target: 0.7 }
    }
}

impl OpticsSection {
    /// Refuses light, lenses and sensors that cannot be.
    pub fn check(&self) -> Result<(), OpticsError> {
        let (laser, lamp, sensor, gain) = (&self.laser, &self.lamp, &self.sensor, &self.gain);
        let mut ranges = vec![
            ("rate_hz", self.rate_hz, 0.1, 10_000.0),
            ("exposure_us", self.exposure_us, 1.0, 1e6 / self.rate_hz.max(0.1)),
            ("lamp_every", self.lamp_every as f64, 2.0, 1e6),
            ("psf_sigma_px", self.psf_sigma_px, 0.3, 3.0),
            ("vignetting", self.vignetting, 0.0, 2.0),
            ("laser.line_length_mm", laser.line_length_mm, 1.0, 10_000.0),
            ("laser.line_distance_mm", laser.line_distance_mm, 1.0, 10_000.0),
            ("laser.thickness_mm", laser.thickness_mm, 1e-3, 10.0),
            ("laser.end_level", laser.end_level, 0.0, 1.0),
            ("laser.level", laser.level, 0.0, 1e3),
            ("laser.speckle_contrast", laser.speckle_contrast, 0.0, 1.0),
            ("lamp.level", lamp.level, 0.0, 1e3),
            ("sensor.full_well_electrons", sensor.full_well_electrons, 10.0, 1e9),
            ("sensor.read_noise_electrons", sensor.read_noise_electrons, 0.0, 1e6),
            ("sensor.gamma", sensor.gamma, 0.2, 5.0),
            ("gain.lowest", gain.lowest, 1e-3, 1e3),
            ("gain.highest", gain.highest, gain.lowest.max(1e-3), 1e3),
            ("gain.target", gain.target, 0.01, 1.0),
        ];
        ranges.extend(laser.response.map(|share| ("laser.response", share, 0.0, 10.0)));
        ranges.extend(sensor.sensitivity.map(|share| ("sensor.sensitivity", share, 1e-3, 10.0)));
        ranges.extend(lamp.position_mm.map(|mm| ("lamp.position_mm", mm, -1e4, 1e4)));
        ranges.extend(laser.source_mm.into_iter().flatten().map(|mm| ("laser.source_mm", mm, -1e4, 1e4)));
        let bad = ranges.into_iter().find(|(_, value, low, high)| !(low..=high).contains(&value));
        bad.map_or(Ok(()), |(key, value, low, high)| Err(OpticsError::Value { key, value, low, high }))
    }
}
