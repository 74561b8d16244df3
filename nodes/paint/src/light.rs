//! How much light a place gets from the lamp, and how much of what it sends back the lens lets through.

use crate::Config;
use nalgebra::Vector3;

/// The lamp and the lens, in the frame of the camera.
#[derive(Debug, Clone, Copy)]
pub struct Light {
    lamp_m: Vector3<f32>,
    vignetting_exponent: f32,
    highlight_cosine: f32,
}

/// The light at one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lit {
    /// Irradiance by the lamp, as a share of that on a surface which faces it at 0.2 m; 0 where it grazes the
    /// surface or shines from behind.
    pub irradiance: f32,
    /// Share of the light that the lens lets through, 1 on the axis.
    pub vignetting: f32,
    /// The place may mirror the lamp into the lens.
    pub gleams: bool,
}

/// Light that falls in flatter than this (cosine of 84 degrees) is all error of the normal.
const GRAZING_COSINE: f32 = 0.1;

/// The paper's working distance: the scale of irradiance, which cancels in the finished texture.
pub(crate) const WORKING_DISTANCE_M: f32 = 0.2;

impl Light {
    /// As configured.
    pub fn new(config: &Config) -> Self {
        Self {
            lamp_m: Vector3::from(config.lamp_from_camera_m).cast(),
            vignetting_exponent: config.vignetting_exponent as f32,
            highlight_cosine: config.highlight_degrees.to_radians().cos() as f32,
        }
    }

    /// The light at a place (in the frame of the camera) with this unit normal: inverse square of the distance, cosine of
    /// the angle at which it falls in (Lambert), and cos^n of the angle off the optical axis (Horn 1986).
    pub fn at(&self, p_in_camera: &Vector3<f32>, normal: &Vector3<f32>) -> Lit {
        let to_lamp = self.lamp_m - p_in_camera;
        let squared = to_lamp.norm_squared().max(f32::MIN_POSITIVE);
        let to_lamp = to_lamp / squared.sqrt();
        let to_camera = -p_in_camera / p_in_camera.norm().max(f32::MIN_POSITIVE);
        let middle = to_lamp + to_camera;
        let cosine = normal.dot(&to_lamp);
        let cosine = if cosine < GRAZING_COSINE { 0.0 } else { cosine };
        Lit {
            irradiance: WORKING_DISTANCE_M * WORKING_DISTANCE_M / squared * cosine,
            vignetting: (-to_camera.z).max(0.0).powf(self.vignetting_exponent),
            gleams: normal.dot(&middle) >= self.highlight_cosine * middle.norm(),
        }
    }
}
