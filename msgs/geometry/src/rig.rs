//! A handset as a file: rig.toml, the same words in a scan folder and in config/rigs.

use crate::{Camera, CameraError, LaserSheet, SheetError, rigid_from_wire, rigid_to_wire};
use nalgebra::{Isometry3, Vector3};
use serde::{Deserialize, Serialize};
use wire::{Calibration, Header, LaserPlane, PeaksPer, RigidPose};

/// What rig.toml holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rig {
    /// What the handset is called; the file's name when it does not say.
    #[serde(default)]
    pub name: String,
    /// The camera.
    pub camera: Camera,
    /// The laser.
    pub laser: LaserSection,
    /// The camera on the handset (hand-eye).
    pub body_from_camera: TransformSection,
    /// The clocks.
    #[serde(default)]
    pub clock: ClockSection,
    /// What only the simulator needs to know of this handset; the crate `world` reads it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub simulation: Option<toml::Table>,
}

/// `[laser]`: normal . p_in_camera = distance_m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LaserSection {
    /// Any length; it is made a unit vector together with the distance.
    pub normal: [f64; 3],
    /// Along the normal.
    pub distance_m: f64,
    /// How much of red, green and blue is summed into the laser's grey level.
    pub channel_weights: [f64; 3],
    /// "row" or "column".
    #[serde(with = "peaks_per")]
    pub peaks_per: PeaksPer,
}

/// A rigid transform.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TransformSection {
    /// In metres.
    pub translation_m: [f64; 3],
    /// Unit quaternion w, x, y, z.
    pub rotation_wxyz: [f64; 4],
}

/// `[clock]`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClockSection {
    /// Added to a pose's stamp, it gives the camera's clock.
    #[serde(default)]
    pub pose_offset_s: f64,
}

/// Why a rig cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RigError {
    /// Not TOML, an unknown key, a missing one.
    #[error("{0}")]
    Parse(String),
    /// The camera.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The laser.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// The channels.
    #[error("[laser] channel_weights = {0:?}: finite, and at least one above 0")]
    Weights([f64; 3]),
    /// Hand-eye.
    #[error("[body_from_camera] {0:?} is no rigid transform: finite numbers and a unit quaternion w, x, y, z")]
    Transform(TransformSection),
    /// The clock.
    #[error("[clock] pose_offset_s = {0}: at most 10 s either way")]
    Clock(f64),
}

impl Rig {
    /// Reads and checks.
    pub fn parse(text: &str) -> Result<Self, RigError> {
        let rig: Self = toml::from_str(text).map_err(|e| RigError::Parse(e.to_string()))?;
        rig.check()?;
        Ok(rig)
    }

    /// Refuses a handset that cannot measure.
    pub fn check(&self) -> Result<(), RigError> {
        self.camera.check()?;
        self.sheet()?;
        let weights = self.laser.channel_weights;
        if !weights.iter().all(|w| w.is_finite()) || weights.iter().all(|w| *w <= 0.0) {
            return Err(RigError::Weights(weights));
        }
        self.body_from_camera()?;
        let offset = self.clock.pose_offset_s;
        if !offset.is_finite() || offset.abs() > 10.0 {
            return Err(RigError::Clock(offset));
        }
        Ok(())
    }

    /// The laser sheet.
    pub fn sheet(&self) -> Result<LaserSheet, SheetError> {
        LaserSheet::new(Vector3::from(self.laser.normal), self.laser.distance_m)
    }

    /// The camera on the handset.
    pub fn body_from_camera(&self) -> Result<Isometry3<f64>, RigError> {
        let TransformSection { translation_m, rotation_wxyz } = self.body_from_camera;
        rigid_from_wire(&RigidPose { translation_m, rotation_wxyz }).ok_or(RigError::Transform(self.body_from_camera))
    }

    /// As it travels.
    pub fn calibration(&self) -> Result<Calibration, RigError> {
        let sheet = self.sheet()?;
        Ok(Calibration {
            header: Header::default(),
            camera: (&self.camera).into(),
            laser: LaserPlane {
                normal: sheet.normal.into(),
                distance_m: sheet.distance_m,
                channel_weights: self.laser.channel_weights,
                peaks_per: self.laser.peaks_per,
            },
            body_from_camera: rigid_to_wire(&self.body_from_camera()?),
            pose_offset_nanos: (self.clock.pose_offset_s * 1e9).round() as i64,
            name: self.name.clone(),
        })
    }

    /// As it came over the wire.
    pub fn from_calibration(calibration: &Calibration) -> Result<Self, RigError> {
        let rig = Self {
            name: calibration.name.clone(),
            camera: (&calibration.camera).into(),
            laser: LaserSection {
                normal: calibration.laser.normal,
                distance_m: calibration.laser.distance_m,
                channel_weights: calibration.laser.channel_weights,
                peaks_per: calibration.laser.peaks_per,
            },
            body_from_camera: TransformSection {
                translation_m: calibration.body_from_camera.translation_m,
                rotation_wxyz: calibration.body_from_camera.rotation_wxyz,
            },
            clock: ClockSection { pose_offset_s: calibration.pose_offset_nanos as f64 * 1e-9 },
            simulation: None,
        };
        rig.check()?;
        Ok(rig)
    }
}

mod peaks_per {
    use serde::{Deserialize as _, Deserializer, Serializer, de::Error as _};
    use wire::PeaksPer;

    pub fn serialize<S: Serializer>(value: &PeaksPer, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(match value {
            PeaksPer::Row => "row",
            PeaksPer::Column => "column",
        })
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<PeaksPer, D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "row" => Ok(PeaksPer::Row),
            "column" => Ok(PeaksPer::Column),
            other => Err(D::Error::custom(format!("peaks_per = {other:?}: say \"row\" or \"column\""))),
        }
    }
}
