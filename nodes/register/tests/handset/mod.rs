//! A handset on a known way over a surface that is known exactly.

use geometry::{Camera, LaserSheet};
use nalgebra::{Isometry3, Point2, Point3, Translation3, UnitQuaternion, Vector3};
use wire::{Bulk, Calibration, Header, LaserPlane, Light, PeaksPer, Phase, Pose, Quality, Stripe, StripePeak};

/// One frame in 40 ms, one pose in 10 ms.
pub const FRAME_NANOS: i64 = 40_000_000;
pub const POSE_NANOS: i64 = 10_000_000;

pub fn camera() -> Camera {
    let distortion = [-0.12, 0.05, 0.0004, -0.0003, 0.0];
    Camera { width: 768, height: 576, fx: 900.0, fy: 902.0, cx: 380.5, cy: 290.0, distortion }
}

pub fn sheet() -> LaserSheet {
    LaserSheet::new(Vector3::new(-0.87, 0.02, 0.48), 0.096).unwrap()
}

fn body_from_camera() -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::new(0.04, -0.02, 0.03), UnitQuaternion::from_euler_angles(0.2, -0.3, 1.0))
}

/// Looks down from 0.2 m and sweeps sideways, turning as it goes.
pub fn world_from_camera(stamp_nanos: i64) -> Isometry3<f64> {
    let t = stamp_nanos as f64 * 1e-9;
    let down = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    let turn = UnitQuaternion::new(Vector3::new(0.05, -0.1, 0.08) * t);
    Isometry3::from_parts(Translation3::new(0.02 * (t - 1.0), 0.01 * t, 0.2), turn * down)
}

pub fn calibration() -> Calibration {
    let sheet = sheet();
    Calibration {
        header: Header::default(),
        camera: (&camera()).into(),
        laser: LaserPlane {
            normal: sheet.normal.into(),
            distance_m: sheet.distance_m,
            channel_weights: [1.0, -0.5, -0.5],
            peaks_per: PeaksPer::Row,
        },
        body_from_camera: geometry::rigid_to_wire(&body_from_camera()),
        pose_offset_nanos: 3_000_000,
        name: "test".to_owned(),
    }
}

fn header(stamp_nanos: i64) -> Header {
    Header { scan: 1, phase: Phase::Shape, stamp_nanos, ..Header::default() }
}

/// The tracker's clock is 3 ms behind the camera's.
pub fn pose(stamp_nanos: i64) -> Pose {
    let world_from_body = world_from_camera(stamp_nanos) * body_from_camera().inverse();
    Pose {
        header: header(stamp_nanos - 3_000_000),
        world_from_body: geometry::rigid_to_wire(&world_from_body),
        position_sigma_m: [1e-3; 3],
        rotation_sigma_rad: [0.01; 3],
        rotation_lag_nanos: 0,
        quality: Quality::Good,
        reason: String::new(),
    }
}

/// The stripe on the surface `distance(p_in_world) = 0`, row by row: where along a row the sheet crosses the surface.
/// `noise_px` is added to each peak.
pub fn stripe(
    stamp_nanos: i64,
    distance: &impl Fn(&Point3<f64>) -> f64,
    sigma_px: f64,
    mut noise_px: impl FnMut() -> f64,
) -> Stripe {
    let (camera, sheet, world_from_camera) = (camera(), sheet(), world_from_camera(stamp_nanos));
    let above = |u: f64, v: f64| {
        let p_in_camera = sheet.intersect(&camera.direction(Point2::new(u, v))).filter(|p| p.z < 0.5)?;
        Some(distance(&(world_from_camera * p_in_camera)))
    };
    let crossing = |v: f64| -> Option<f64> {
        const STEP_PX: f64 = 16.0;
        let starts = (0..48).map(|i| f64::from(i) * STEP_PX).filter(|u| u + STEP_PX < 767.0);
        let sign = |u| above(u, v).map(f64::signum);
        let mut low =
            starts.into_iter().find(|&u| matches!((sign(u), sign(u + STEP_PX)), (Some(a), Some(b)) if a != b))?;
        let side = sign(low)?;
        let mut high = low + STEP_PX;
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if sign(middle)? == side { low = middle } else { high = middle }
        }
        Some(low)
    };
    let peaks = (0..576).step_by(6).filter_map(|v| {
        let u = crossing(f64::from(v))?;
        Some(StripePeak {
            u_px: (u + sigma_px * noise_px()) as f32,
            v_px: v as f32,
            sigma_px: sigma_px as f32,
            amplitude: 90.0,
            width_px: 1.5,
            flags: StripePeak::BEST,
        })
    });
    Stripe {
        header: header(stamp_nanos),
        width: 768,
        height: 576,
        light: Light { laser: true, lamp: false },
        peaks: Bulk(peaks.collect()),
        refused: Vec::new(),
    }
}
