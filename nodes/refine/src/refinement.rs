//! What comes out: the way of the camera, made consistent, and the points on it.

use crate::Evidence;
use geometry::{TimedPose, rigid_to_wire};
use nalgebra::Vector3;
use std::sync::Arc;
use wire::{Bulk, Extent, Header, ProfilePoint, Scan, ScanPoint};

/// A refined scan, as far as it has come. It shares the points with the refiner, so it may go to another thread.
#[derive(Debug, Clone)]
pub struct Refinement {
    /// world_from_camera every two milliseconds, so that a straight line between two samples is right to some microns;
    /// from half a second before the first frame to half a second behind the last. None where the tracker was silent.
    pub trajectory: Vec<TimedPose>,
    /// What is known of it.
    pub evidence: Evidence,
    pub(crate) frames: Vec<RefinedFrame>,
}

/// A frame whose points are given out.
#[derive(Debug, Clone)]
pub(crate) struct RefinedFrame {
    pub header: Header,
    pub points: Arc<[ProfilePoint]>,
    /// world_from_camera.
    pub pose: TimedPose,
    /// How far the pose's error moves its points across the surface: one standard deviation.
    pub across_sigma_m: f64,
    /// How far the whole region that it saw may stand off; 0 where nobody asked.
    pub region_sigma_m: f64,
}

impl Refinement {
    /// The points of each frame that was kept, in the order of the stamps. A point's sigma is that of its
    /// range together with what the pose's error moves points of this frame across the surface.
    pub fn scans(&self) -> impl ExactSizeIterator<Item = Scan> + '_ {
        self.frames.iter().map(RefinedFrame::scan)
    }
}

impl RefinedFrame {
    pub(crate) fn scan(&self) -> Scan {
        let pose = &self.pose.pose;
        let rotation = pose.rotation.to_rotation_matrix().into_inner().cast::<f32>();
        let place = |point: &ProfilePoint| {
            let ray = rotation * Vector3::from(point.position_m);
            let position_m = [0, 1, 2].map(|i| (pose.translation.vector[i] + f64::from(ray[i])) as f32);
            let to_sensor = (-ray / ray.norm()).into();
            let sigma_m = f64::from(point.range_sigma_m).hypot(self.across_sigma_m) as f32;
            ScanPoint { position_m, to_sensor, sigma_m, amplitude: point.amplitude }
        };
        Scan {
            header: self.header.derived(),
            extent: Extent::Whole,
            world_from_camera: rigid_to_wire(pose),
            // The points' own sigmas hold what the pose's error does to the surface. Where the whole stands is another matter.
            position_sigma_m: 0.0,
            rotation_sigma_rad: 0.0,
            region_sigma_m: self.region_sigma_m,
            points: self.points.iter().map(place).collect::<Bulk<_>>(),
            refused: Vec::new(),
        }
    }
}
