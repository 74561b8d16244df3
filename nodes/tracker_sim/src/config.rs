//! What the simulated tracker is told: the world, and which receiver on the handset it is.

use geometry::{Rig, RigError, TransformSection, rigid_from_wire, rigid_to_wire};
use nalgebra::Isometry3;
use serde::{Deserialize, Serialize};
use wire::RigidPose;
use world::Setup;

/// The configuration of the node.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// As the simulated camera has it.
    #[serde(flatten)]
    pub setup: Setup,
    /// body_from_receiver: this is one of several receivers on the handset, with noise of its own by the name of the
    /// instance. None: it is the only one, and sits where the body's frame is.
    pub receiver: Option<TransformSection>,
}

/// A receiver that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReceiverError {
    /// Its place on the handset.
    #[error("tracker_sim: receiver = {0:?} is no rigid transform: finite metres and a unit quaternion w, x, y, z")]
    Transform(TransformSection),
    /// The handset.
    #[error(transparent)]
    Rig(#[from] RigError),
}

impl Config {
    /// Refuses what makes no sense.
    pub fn check(&self) -> Result<(), ReceiverError> {
        self.receiver.as_ref().map_or(Ok(()), |receiver| body_from_receiver(receiver).map(drop))
    }
}

/// The rig as a receiver has it: the body's frame is its own.
pub(crate) fn seen_from(rig: &Rig, receiver: &TransformSection) -> Result<Rig, ReceiverError> {
    let receiver_from_camera = body_from_receiver(receiver)?.inverse() * rig.body_from_camera()?;
    let RigidPose { translation_m, rotation_wxyz } = rigid_to_wire(&receiver_from_camera);
    Ok(Rig { body_from_camera: TransformSection { translation_m, rotation_wxyz }, ..rig.clone() })
}

fn body_from_receiver(receiver: &TransformSection) -> Result<Isometry3<f64>, ReceiverError> {
    let TransformSection { translation_m, rotation_wxyz } = *receiver;
    rigid_from_wire(&RigidPose { translation_m, rotation_wxyz }).ok_or(ReceiverError::Transform(*receiver))
}
