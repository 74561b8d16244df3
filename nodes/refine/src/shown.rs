//! What of a revision is new to whoever has the one before.

use crate::Refinement;
use crate::refinement::RefinedFrame;
use geometry::rigid_from_wire;
use nalgebra::{Isometry3, Vector3};
use std::collections::BTreeMap;
use wire::{Header, Scan};

/// Where the frames of a scan stand for its readers.
#[derive(Debug, Clone, Default)]
pub struct Shown {
    frames: BTreeMap<i64, (Header, Isometry3<f64>)>,
}

impl Shown {
    /// Nothing was shown yet.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// A frame went to the readers beside all revisions, as the tracker has it.
    pub fn relayed(&mut self, scan: &Scan) {
        if let Some(world_from_camera) = rigid_from_wire(&scan.world_from_camera).filter(|_| !scan.points.is_empty()) {
            self.frames.insert(scan.header.stamp_nanos, (scan.header, world_from_camera));
        }
    }

    /// What the readers must take again, in the order of the stamps: frames that are new to them, or of which a point moved
    /// by more than `moved_m` since they went; and without points those that are left out now. From then on they have it.
    /// Frames behind the last that the refinement tells of stay as they are.
    pub fn changes(&mut self, refinement: &Refinement, moved_m: f64) -> Vec<Scan> {
        let kept: BTreeMap<i64, &RefinedFrame> =
            refinement.frames.iter().map(|frame| (frame.header.stamp_nanos, frame)).collect();
        let last = refinement.evidence.last_frame_nanos().unwrap_or(i64::MIN);
        let left_out = self.frames.range(..=last).filter(|(stamp, _)| !kept.contains_key(stamp));
        let mut changes: BTreeMap<i64, Scan> =
            left_out.map(|(stamp, (header, _))| (*stamp, Scan::none(header.derived()))).collect();
        for stamp in changes.keys() {
            self.frames.remove(stamp);
        }
        for (stamp, frame) in kept {
            if self.frames.get(&stamp).is_none_or(|(_, then)| has_moved(frame, then, moved_m)) {
                self.frames.insert(stamp, (frame.header, frame.pose.pose));
                changes.insert(stamp, frame.scan());
            }
        }
        changes.into_values().collect()
    }
}

/// Whether a point of the frame stands farther than that from where it stood.
fn has_moved(frame: &RefinedFrame, then: &Isometry3<f64>, moved_m: f64) -> bool {
    let now = &frame.pose.pose;
    let [turn_now, turn_then] = [now, then].map(|pose| pose.rotation.to_rotation_matrix().into_inner());
    let turned = (turn_now - turn_then).cast::<f32>();
    let shifted = (now.translation.vector - then.translation.vector).cast::<f32>();
    let bound_m2 = (moved_m * moved_m) as f32;
    frame.points.iter().any(|point| (turned * Vector3::from(point.position_m) + shifted).norm_squared() > bound_m2)
}
