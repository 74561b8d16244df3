//! Points against a way that is known exactly, and everything that can be wrong with poses.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use register::{Config, Register};
use wire::*;

const MS: i64 = 1_000_000;

fn header(stamp_nanos: i64) -> Header {
    Header { scan: 1, stamp_nanos, phase: Phase::Shape, ..Header::default() }
}

fn wire_pose(transform: &Isometry3<f64>) -> RigidPose {
    geometry::rigid_to_wire(transform)
}

fn body_from_camera() -> Isometry3<f64> {
    let rotation = UnitQuaternion::from_euler_angles(0.3, -0.4, 1.2);
    Isometry3::from_parts(Translation3::new(0.05, -0.03, 0.02), rotation)
}

/// Turns at a constant rate while it moves at a constant speed: what the interpolation is exact for.
fn world_from_body(stamp_nanos: i64) -> Isometry3<f64> {
    let t = stamp_nanos as f64 * 1e-9;
    let rotation =
        UnitQuaternion::new(Vector3::new(0.2, 0.5, -0.3) * t) * UnitQuaternion::from_euler_angles(1.0, 0.0, 0.5);
    Isometry3::from_parts(Translation3::new(0.3 + 0.1 * t, -0.05 * t, 0.4), rotation)
}

fn calibration(pose_offset_nanos: i64) -> Calibration {
    let camera =
        CameraIntrinsics { width: 640, height: 480, fx: 800.0, fy: 800.0, cx: 320.0, cy: 240.0, distortion: [0.0; 5] };
    let laser =
        LaserPlane { normal: [-0.8, 0.0, 0.6], distance_m: 0.1, channel_weights: [1.0; 3], peaks_per: PeaksPer::Row };
    let body_from_camera = wire_pose(&body_from_camera());
    Calibration { header: Header::default(), camera, laser, body_from_camera, pose_offset_nanos, name: String::new() }
}

fn pose(stamp_nanos: i64, world_from_body: &Isometry3<f64>) -> Pose {
    Pose {
        header: header(stamp_nanos),
        world_from_body: wire_pose(world_from_body),
        position_sigma_m: [1e-3, 2e-3, 1e-3],
        rotation_sigma_rad: [0.01; 3],
        rotation_lag_nanos: 0,
        quality: Quality::Good,
        reason: String::new(),
    }
}

fn profile(stamp_nanos: i64) -> Profile {
    let point =
        |i: u32| ProfilePoint { position_m: [0.01 * i as f32, -0.02, 0.2], range_sigma_m: 1e-4, ..Default::default() };
    Profile { header: header(stamp_nanos), points: (0..5).map(point).collect(), refused: vec![] }
}

fn reasons(refused: &[Refusal]) -> Vec<(&str, u64)> {
    refused.iter().map(|refusal| (refusal.reason.as_str(), refusal.count)).collect()
}

#[test]
fn points_land_where_the_way_puts_them_clock_offset_and_hand_eye_included() {
    let offset = -7 * MS;
    let mut register = Register::new(Config::default(), &calibration(offset)).unwrap();
    for i in 0..40 {
        // The tracker's clock is 7 ms ahead.
        register.pose(&pose(i * 10 * MS - offset, &world_from_body(i * 10 * MS)));
    }
    for stamp in [3 * MS, 50 * MS, 123_456_789, 389 * MS] {
        register.profile(profile(stamp));
        let scan = register.drain().next().unwrap();
        let world_from_camera = world_from_body(stamp) * body_from_camera();
        for (found, given) in scan.points.iter().zip(profile(stamp).points.iter()) {
            let truth = world_from_camera * Point3::from(given.position_m).cast::<f64>();
            assert!((Point3::from(found.position_m).cast::<f64>() - truth).norm() < 1e-6);
            let to_sensor = (Point3::from(world_from_camera.translation.vector) - truth).normalize();
            assert!((Vector3::from(found.to_sensor).cast::<f64>() - to_sensor).norm() < 1e-5);
        }
        assert_eq!((scan.position_sigma_m, scan.header.stamp_nanos), (2e-3, stamp));
    }
    let way = register.trajectory().unwrap();
    assert_eq!((way.samples.len(), way.samples[3].stamp_nanos), (40, 30 * MS));
    assert!(register.trajectory().is_none(), "each sample is told once");
}

#[test]
fn a_rotation_that_is_older_than_its_position_is_taken_at_its_own_moment() {
    let mut register = Register::new(Config::default(), &calibration(0)).unwrap();
    let lag = 12 * MS;
    for i in 0..40 {
        let stamp = i * 10 * MS;
        let parts = Isometry3::from_parts(world_from_body(stamp).translation, world_from_body(stamp - lag).rotation);
        register.pose(&Pose { rotation_lag_nanos: lag, ..pose(stamp, &parts) });
    }
    register.profile(profile(155 * MS));
    let scan = register.drain().next().unwrap();
    let truth = world_from_body(155 * MS) * body_from_camera();
    let found = geometry::rigid_from_wire(&scan.world_from_camera).unwrap();
    assert!(
        found.rotation.angle_to(&truth.rotation) < 1e-9
            && (found.translation.vector - truth.translation.vector).norm() < 1e-9
    );
}

#[test]
fn each_refusal_is_counted_by_its_reason() {
    let mut register = Register::new(Config::default(), &calibration(0)).unwrap();
    register.profile(profile(5 * MS));
    for stamp in [10, 20, 15, 400, 410] {
        register.pose(&pose(stamp * MS, &world_from_body(stamp * MS)));
    }
    register.pose(&Pose { quality: Quality::Lost, ..pose(420 * MS, &world_from_body(0)) });
    let mut bad = pose(430 * MS, &world_from_body(0));
    bad.world_from_body.rotation_wxyz[2] = f64::NAN;
    register.pose(&bad);
    register.profile(profile(200 * MS));
    register.profile(profile(405 * MS));
    let mut not_finite = profile(406 * MS);
    not_finite.points[2].position_m[1] = f32::INFINITY;
    register.profile(not_finite);
    register.profile(profile(450 * MS));
    register.profile(profile(449 * MS));
    let scans: Vec<Scan> = register.drain().collect();
    assert_eq!(scans.iter().map(|scan| scan.points.len()).collect::<Vec<_>>(), [5, 4]);
    let mut all: Vec<Refusal> = scans.into_iter().flat_map(|scan| scan.refused).collect();
    all.extend(register.finish());
    let mut told = reasons(&all);
    told.sort_unstable();
    assert_eq!(
        told,
        [
            ("point that is not finite", 1),
            ("pose that is no rigid transform", 1),
            ("pose that the tracker calls lost", 1),
            ("pose whose time goes backwards", 1),
            ("profile after the last pose", 1),
            ("profile before the first pose", 1),
            ("profile in a gap between poses", 1),
            ("profile whose time goes backwards", 1),
        ]
    );
}

#[test]
fn a_silent_tracker_is_waited_for_only_so_long() {
    let config = Config { most_wait_ms: 100.0, ..Config::default() };
    let mut register = Register::new(config, &calibration(0)).unwrap();
    register.pose(&pose(0, &world_from_body(0)));
    for i in 1..=30 {
        register.profile(profile(i * 10 * MS));
    }
    let refused = register.finish();
    assert_eq!(
        reasons(&refused),
        [("profile after the last pose", 11), ("profile without a pose behind it in time", 19)]
    );
}

#[test]
fn a_new_scan_starts_afresh_and_an_old_one_is_refused() {
    let mut register = Register::new(Config::default(), &calibration(0)).unwrap();
    register.pose(&pose(500 * MS, &world_from_body(0)));
    let next = Header { scan: 2, ..header(0) };
    register.pose(&Pose { header: next, ..pose(0, &world_from_body(0)) });
    register.pose(&Pose { header: Header { stamp_nanos: 10 * MS, ..next }, ..pose(0, &world_from_body(10 * MS)) });
    register.profile(Profile { header: Header { stamp_nanos: 5 * MS, ..next }, ..profile(0) });
    assert_eq!(register.drain().count(), 1);
    register.profile(profile(5 * MS));
    assert_eq!(reasons(&register.finish()), [("profile of an older scan", 1)]);
}

proptest! {
    #[test]
    fn whatever_comes_is_registered_or_refused(stamps in proptest::collection::vec((any::<i64>(), any::<bool>(), any::<f64>()), 0..60)) {
        let mut register = Register::new(Config::default(), &calibration(0)).unwrap();
        let mut profiles = 0u64;
        let mut scans = 0u64;
        let mut refused = 0u64;
        for (stamp, is_pose, x) in stamps {
            if is_pose {
                let mut any = pose(stamp, &Isometry3::identity());
                any.world_from_body.translation_m[0] = x;
                register.pose(&any);
            } else {
                profiles += 1;
                register.profile(profile(stamp));
            }
            for scan in register.drain() {
                scans += 1;
                refused += scan.refused.iter().filter(|r| r.reason.starts_with("profile")).map(|r| r.count).sum::<u64>();
            }
        }
        refused += register.finish().iter().filter(|r| r.reason.starts_with("profile")).map(|r| r.count).sum::<u64>();
        prop_assert_eq!(scans + refused, profiles);
    }
}
