//! The operator's hand: where the handset truly is at any moment.
//!
//! A pure function of (scene, rig, seconds, seed, time). The strokes are planned around the thing's bounds so that the
//! sheet's working point, where it crosses the camera's axis, runs over the surface (`plan`); then they are made human:
//! uneven pace and stand-off, sway, and tremor at 8 to 12 Hz (`sway`).

mod aim;
mod plan;
mod section;
mod stroke;
mod sway;

pub use section::HandSection;

use crate::{Scene, Simulation, SimulationError};
use aim::{Aim, Reach};
use geometry::{METRES_PER_MM, Rig, RigError};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector2};
use stroke::Stroke;
use sway::Sway;
use wire::{PeaksPer, Phase};

/// Why nobody can sweep so.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HandError {
    /// Too short or too long.
    #[error("a sweep of {0} s: 1 s to 3600 s")]
    Seconds(f64),
    /// The scene's subject has no vertices.
    #[error("the scene shows nothing to scan")]
    Nothing,
    /// The stripe is so short beside the thing that no hand would go over all of it.
    #[error(
        "the camera sees {stripe_mm:.1e} mm of the stripe at the stand-off, and the thing is {size_mm:.0} mm large: more than \
         {MOST_LANES:.0} lanes side by side are no sweep; check width, height, fx and fy of the rig's [camera], and the thing's size"
    )]
    Lanes {
        /// The usable length of the stripe.
        stripe_mm: f64,
        /// The largest side of the thing.
        size_mm: f64,
    },
    /// The handset cannot measure.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// What the rig file tells of the simulation cannot be.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// The sweep.
#[derive(Debug, Clone)]
pub struct Hand {
    reach: Reach,
    strokes: Vec<Stroke>,
    length_m: f64,
    rest: Aim,
    duration_s: f64,
    two_passes: bool,
    camera_from_body: Isometry3<f64>,
    pace: Sway,
    stand_off: Sway,
    sway: [Sway; 2],
    tremor: [Sway; 2],
}

/// The operator presses the button after this time; what was seen before is not kept.
const AIMING_S: f64 = 0.3;
/// The usable part of the stripe's length: its ends wander out of the picture.
const STRIPE_SHARE: f64 = 0.8;
/// The stripe is no longer than this at the stand-off (paper, section 3: 12 cm).
const STRIPE_LIMIT_M: f64 = 0.12;
/// No more strokes than this side by side over the thing.
const MOST_LANES: f64 = 200.0;
const STAND_OFF_HZ: [f64; 2] = [0.05, 0.5];
const PACE_HZ: [f64; 2] = [0.1, 0.6];
const SWAY_HZ: [f64; 2] = [0.15, 2.0];
/// Physiological tremor of the hand.
const TREMOR_HZ: [f64; 2] = [8.0, 12.0];

impl Hand {
    /// Plans a sweep of so many seconds.
    pub fn new(scene: &Scene, rig: &Rig, seconds: f64, seed: u64) -> Result<Self, HandError> {
        if !(1.0..=3600.0).contains(&seconds) {
            return Err(HandError::Seconds(seconds));
        }
        let section = scene.hand;
        let reach = reach(scene, rig)?;
        let error = Simulation::from_rig(rig)?.hand_eye_error;
        let passes = if section.two_passes { 2.0 } else { 1.0 };
        let budget_m = section.speed_limit_mm_per_s * METRES_PER_MM * seconds / passes;
        let (stripe_m, size_m) = (stripe_length_m(rig, reach.stand_off_m), 2.0 * reach.half.max());
        if size_m.is_nan() || size_m > MOST_LANES * stripe_m {
            return Err(HandError::Lanes { stripe_mm: stripe_m / METRES_PER_MM, size_mm: size_m / METRES_PER_MM });
        }
        let strokes = plan::plan(&reach, stripe_m, budget_m, section.crossing_strokes);
        let [mm, degrees] = [METRES_PER_MM, 1f64.to_radians()];
        let human =
            |rms: f64, band: [f64; 2], stream: u64| Sway::new(rms, band, seed.wrapping_mul(16).wrapping_add(stream));
        // The pace and the stand-off wander along one axis of three.
        let one_axis = 3f64.sqrt();
        Ok(Self {
            rest: strokes.last().map(|stroke| stroke.to).ok_or(HandError::Nothing)?,
            length_m: strokes.iter().map(|stroke| stroke.length_m).sum(),
            reach,
            strokes,
            duration_s: seconds,
            two_passes: section.two_passes,
            camera_from_body: (rig.body_from_camera()? * error.said_from_true()).inverse(),
            pace: human(section.pace_spread * one_axis, PACE_HZ, 0),
            stand_off: human(section.stand_off_spread_mm * mm * one_axis, STAND_OFF_HZ, 1),
            sway: [human(section.sway_mm * mm, SWAY_HZ, 2), human(section.sway_deg * degrees, SWAY_HZ, 3)],
            tremor: [human(section.tremor_mm * mm, TREMOR_HZ, 4), human(section.tremor_deg * degrees, TREMOR_HZ, 5)],
        })
    }

    /// From the first moment to the last.
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// What the operator does at a moment, in seconds from the start.
    pub fn phase(&self, t_s: f64) -> Phase {
        let second_pass = t_s >= 0.5 * self.duration_s;
        match t_s {
            t if t < AIMING_S => Phase::Aim,
            t if t >= self.duration_s => Phase::End,
            _ if !self.two_passes => Phase::Both,
            _ if second_pass => Phase::Colour,
            _ => Phase::Shape,
        }
    }

    /// The tracker's receiver, in the world, at a moment in seconds from the start; the hand rests before and behind.
    pub fn world_from_body(&self, t_s: f64) -> Isometry3<f64> {
        self.world_from_camera(t_s) * self.camera_from_body
    }

    /// The camera, in the world.
    pub fn world_from_camera(&self, t_s: f64) -> Isometry3<f64> {
        let meant = self.reach.world_from_camera(&self.aim(t_s), self.stand_off.at(t_s).x);
        let [shift, turn] = [0, 1].map(|i| self.sway[i].at(t_s) + self.tremor[i].at(t_s));
        Isometry3::from_parts(
            Translation3::from(meant.translation.vector + shift),
            meant.rotation * UnitQuaternion::new(turn),
        )
    }

    fn aim(&self, t_s: f64) -> Aim {
        let pass_s = if self.two_passes { 0.5 * self.duration_s } else { self.duration_s };
        let in_pass = if self.two_passes && t_s >= pass_s { t_s - pass_s } else { t_s }.clamp(0.0, pass_s);
        let uneven = |t: f64| t + self.pace.integral_of_x(t);
        let mut left_m = self.length_m * (uneven(in_pass) / uneven(pass_s)).clamp(0.0, 1.0);
        for stroke in &self.strokes {
            if left_m <= stroke.length_m {
                return stroke.at(left_m / stroke.length_m.max(f64::MIN_POSITIVE));
            }
            left_m -= stroke.length_m;
        }
        self.rest
    }
}

fn reach(scene: &Scene, rig: &Rig) -> Result<Reach, HandError> {
    let [low, high] = scene.subject().mesh.bounds().ok_or(HandError::Nothing)?.map(|p| p.cast::<f64>());
    let sheet = rig.sheet().map_err(RigError::from)?;
    let across = sheet.normal.xy();
    // A sheet straight across the axis leaves from nowhere beside the camera; then any side will do.
    let laser_offset_m = match across.norm_squared() {
        square if square > 1e-6 => across * (sheet.distance_m / square),
        _ => Vector2::new(-0.1, 0.0),
    };
    Ok(Reach {
        centre: nalgebra::center(&low, &high),
        half: (0.5 * (high - low)).map(|side| side.max(1e-3)),
        stand_off_m: scene.hand.stand_off_mm * METRES_PER_MM,
        laser_offset_m,
    })
}

fn stripe_length_m(rig: &Rig, stand_off_m: f64) -> f64 {
    let camera = &rig.camera;
    let field = match rig.laser.peaks_per {
        PeaksPer::Row => f64::from(camera.height) / camera.fy,
        PeaksPer::Column => f64::from(camera.width) / camera.fx,
    };
    STRIPE_SHARE * (field * stand_off_m).min(STRIPE_LIMIT_M)
}
