//! x = mu v with n . x = d (paper, section 2.2).

use crate::directions::Directions;
use crate::{Config, ConfigError};
use geometry::{Camera, CameraError, LaserSheet, METRES_PER_MM, SheetError};
use nalgebra::Vector3;
use wire::{Calibration, PeaksPer, Profile, ProfilePoint, Refusal, Stripe, StripePeak};

/// Why nothing can be triangulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TriangulatorError {
    /// The gates.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The sheet.
    #[error(transparent)]
    Sheet(#[from] SheetError),
}

/// Why a peak gave no point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Refused {
    NotFinite,
    OffThePicture,
    Saturated,
    Angle,
    Behind,
    Near,
    Far,
    Uncertain,
    OtherPicture,
}

const REASONS: [(Refused, &str); 9] = [
    (Refused::NotFinite, "peak that is not finite"),
    (Refused::OffThePicture, "peak off the picture"),
    (Refused::Saturated, "saturated peak"),
    (Refused::Angle, "ray along the sheet"),
    (Refused::Behind, "sheet behind the camera"),
    (Refused::Near, "point too near"),
    (Refused::Far, "point too far"),
    (Refused::Uncertain, "point too uncertain"),
    (Refused::OtherPicture, "peak in a picture of another size than the calibration's"),
];

/// Turns stripes into profiles.
#[derive(Debug, Clone)]
pub struct Triangulator {
    directions: Directions,
    size: [u32; 2],
    normal: Vector3<f32>,
    distance_m: f32,
    peaks_per: PeaksPer,
    near_m: f32,
    far_m: f32,
    least_sine: f32,
    most_range_sigma_m: f32,
    best_only: bool,
    refuse_saturated: bool,
    refused: [u64; REASONS.len()],
}

impl Triangulator {
    /// For one calibrated handset.
    pub fn new(config: Config, calibration: &Calibration) -> Result<Self, TriangulatorError> {
        config.check()?;
        let camera = Camera::from(&calibration.camera);
        camera.check()?;
        let sheet = LaserSheet::new(Vector3::from(calibration.laser.normal), calibration.laser.distance_m)?;
        Ok(Self {
            directions: Directions::new(&camera),
            size: [camera.width, camera.height],
            normal: sheet.normal.cast(),
            distance_m: sheet.distance_m as f32,
            peaks_per: calibration.laser.peaks_per,
            near_m: (config.near_mm * METRES_PER_MM) as f32,
            far_m: (config.far_mm * METRES_PER_MM) as f32,
            least_sine: config.least_angle_deg.to_radians().sin() as f32,
            most_range_sigma_m: (config.most_range_sigma_mm * METRES_PER_MM) as f32,
            best_only: config.best_only,
            refuse_saturated: config.refuse_saturated,
            refused: [0; REASONS.len()],
        })
    }

    /// The points of a stripe. Peaks that were not chosen are left out without a word (unless the configuration wants
    /// them); whatever else gives no point is counted.
    pub fn process(&mut self, stripe: &Stripe) -> Profile {
        self.refused = [0; REASONS.len()];
        let calibrated = [stripe.width, stripe.height] == self.size;
        let mut points = Vec::with_capacity(stripe.peaks.len());
        for peak in stripe.peaks.iter().filter(|peak| peak.is_best() || !self.best_only) {
            match if calibrated { self.point(peak) } else { Err(Refused::OtherPicture) } {
                Ok(point) => points.push(point),
                Err(reason) => self.refused[reason as usize] += 1,
            }
        }
        let counted = REASONS.iter().zip(self.refused).filter(|(_, count)| *count > 0);
        let refused = counted.map(|((_, reason), count)| Refusal { reason: (*reason).to_owned(), count }).collect();
        Profile { header: stripe.header.derived(), points: points.into(), refused }
    }

    fn point(&self, peak: &StripePeak) -> Result<ProfilePoint, Refused> {
        let numbers = [peak.u_px, peak.v_px, peak.sigma_px, peak.amplitude];
        if !numbers.iter().all(|number| number.is_finite()) || peak.sigma_px < 0.0 {
            return Err(Refused::NotFinite);
        }
        if self.refuse_saturated && peak.flags & StripePeak::SATURATED != 0 {
            return Err(Refused::Saturated);
        }
        let direction = self.directions.at(peak.u_px, peak.v_px).ok_or(Refused::OffThePicture)?;
        let v = Vector3::new(direction.xy[0], direction.xy[1], 1.0);
        let length = v.norm();
        let approach = self.normal.dot(&v); // n . v
        if approach.abs() < self.least_sine * length {
            return Err(Refused::Angle);
        }
        let mu = self.distance_m / approach;
        match mu {
            _ if mu <= 0.0 => return Err(Refused::Behind),
            _ if mu < self.near_m => return Err(Refused::Near),
            _ if mu > self.far_m => return Err(Refused::Far),
            _ => {}
        }
        let across = match self.peaks_per {
            PeaksPer::Row => direction.per_u,
            PeaksPer::Column => direction.per_v,
        };
        // d mu = -mu (n . dv) / (n . v), and the range is mu |v|, so d range = d mu |v| + mu (v . dv) / |v|.
        let mu_per_px = -mu * (self.normal.x * across[0] + self.normal.y * across[1]) / approach;
        let range_per_px = mu_per_px * length + mu * (v.x * across[0] + v.y * across[1]) / length;
        let range_sigma_m = range_per_px.abs() * peak.sigma_px;
        if range_sigma_m > self.most_range_sigma_m {
            return Err(Refused::Uncertain);
        }
        Ok(ProfilePoint {
            position_m: (v * mu).into(),
            range_sigma_m,
            lateral_sigma_m: mu * across[0].hypot(across[1]) * peak.sigma_px,
            amplitude: peak.amplitude,
            line: match self.peaks_per {
                PeaksPer::Row => peak.v_px,
                PeaksPer::Column => peak.u_px,
            }
            .round()
            .max(0.0) as u32,
        })
    }
}
