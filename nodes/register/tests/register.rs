//! Points against a way that is known exactly, and everything that can be wrong with poses.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

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

/// The pose between two readings, told as soon as both are there.
fn straight() -> Config {
    Config { smooth: false, ..Config::default() }
}

fn reasons(refused: &[Refusal]) -> Vec<(&str, u64)> {
    refused.iter().map(|refusal| (refusal.reason.as_str(), refusal.count)).collect()
}

#[test]
fn points_land_where_the_way_puts_them_clock_offset_and_hand_eye_included() {
    let offset = -7 * MS;
    let mut register = Register::new(straight(), &calibration(offset)).unwrap();
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
    let mut register = Register::new(straight(), &calibration(0)).unwrap();
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
    // Whoever waits for the scans hears how far it has come.
    assert_eq!(register.drain().count(), 0);
    let none = register.without_pose().unwrap();
    assert_eq!((none.header.stamp_nanos, none.points.len()), (190 * MS, 0));
    assert_eq!(reasons(&none.refused), [("profile without a pose behind it in time", 19)]);
    assert_eq!(register.without_pose(), None);
    assert_eq!(reasons(&register.finish()), [("profile after the last pose", 11)]);
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

/// Everything that was refused, by reason.
fn told(scans: Vec<Scan>, rest: Vec<Refusal>) -> Vec<(String, u64)> {
    let mut all: Vec<_> = scans.into_iter().flat_map(|scan| scan.refused).chain(rest).collect();
    all.sort_by(|a, b| a.reason.cmp(&b.reason));
    all.into_iter().map(|refusal| (refusal.reason, refusal.count)).collect()
}

#[test]
fn poses_may_all_come_before_the_profiles_or_behind_them() {
    let poses: Vec<Pose> = (0..9000).map(|i| pose(i * 10 * MS, &world_from_body(i * 10 * MS))).collect();
    let profiles: Vec<Profile> = (0..1500).map(|i| profile(i * 40 * MS + MS)).collect();
    let mut poses_first = Register::new(Config::default(), &calibration(0)).unwrap();
    poses.iter().for_each(|pose| poses_first.pose(pose));
    profiles.iter().for_each(|profile| poses_first.profile(profile.clone()));
    let mut profiles_first = Register::new(Config::default(), &calibration(0)).unwrap();
    profiles.iter().for_each(|profile| profiles_first.profile(profile.clone()));
    poses.iter().for_each(|pose| profiles_first.pose(pose));
    let scans: Vec<Scan> = poses_first.drain().collect();
    assert_eq!(scans.len(), 1500);
    assert_eq!(scans, profiles_first.drain().collect::<Vec<_>>());
}

#[test]
fn the_way_has_each_rotation_at_its_own_moment() {
    let mut register = Register::new(straight(), &calibration(0)).unwrap();
    let lag = 25 * MS;
    let mut samples = Vec::new();
    for i in 0..40 {
        let stamp = i * 10 * MS;
        let parts = Isometry3::from_parts(world_from_body(stamp).translation, world_from_body(stamp - lag).rotation);
        register.pose(&Pose { rotation_lag_nanos: lag, ..pose(stamp, &parts) });
        samples.extend(register.trajectory().into_iter().flat_map(|way| way.samples.0));
    }
    // The rotation at the last three readings has not been measured yet.
    assert_eq!((samples.len(), samples[0].stamp_nanos), (37, 0));
    for sample in &samples {
        let truth = world_from_body(sample.stamp_nanos) * body_from_camera();
        let found = geometry::TimedPose::from(sample).pose;
        assert!(found.rotation.angle_to(&truth.rotation) < 1e-9);
        assert!((found.translation.vector - truth.translation.vector).norm() < 1e-9);
    }
}

#[test]
fn poses_of_the_next_scan_do_not_push_out_the_last_profiles_of_this_one() {
    let mut register = Register::new(straight(), &calibration(0)).unwrap();
    let of = |scan, stamp: i64| Header { scan, ..header(stamp * MS) };
    let reading = |scan, stamp| Pose { header: of(scan, stamp), ..pose(0, &world_from_body(stamp * MS)) };
    for stamp in [0, 10, 20] {
        register.pose(&reading(1, stamp));
    }
    for stamp in [500, 510] {
        register.pose(&reading(2, stamp));
    }
    register.profile(Profile { header: of(1, 15), ..profile(0) });
    register.profile(Profile { header: of(1, 25), ..profile(0) });
    register.profile(Profile { header: of(2, 505), ..profile(0) });
    let scans: Vec<Scan> = register.drain().collect();
    assert_eq!(
        scans.iter().map(|s| (s.header.scan, s.header.stamp_nanos / MS)).collect::<Vec<_>>(),
        [(1, 15), (2, 505)]
    );
    assert_eq!(told(scans, register.finish()), [("profile after the last pose".to_owned(), 1)]);
    let ways = [register.trajectory().unwrap(), register.trajectory().unwrap()];
    assert_eq!(ways.map(|way| (way.header.scan, way.samples.len())), [(1, 3), (2, 2)]);
    // Once a scan is finished, the next begins with its first pose.
    register.pose(&reading(3, 900));
    assert_eq!(register.trajectory().unwrap().header.scan, 3);
}

#[test]
fn while_aiming_nothing_is_kept() {
    let mut register = Register::new(Config::default(), &calibration(0)).unwrap();
    register.profile(Profile { header: Header { phase: Phase::Aim, ..header(5 * MS) }, ..profile(0) });
    register.pose(&pose(0, &world_from_body(0)));
    register.pose(&pose(10 * MS, &world_from_body(0)));
    assert_eq!(register.drain().count(), 0);
    assert_eq!(reasons(&register.finish()), [("profile taken while aiming", 1)]);
}

#[test]
fn one_stamp_from_another_time_spoils_nothing() {
    let mut register = Register::new(Config::default(), &calibration(0)).unwrap();
    for stamp in [0, 10, i64::MAX / MS, 20, i64::MIN / MS, 30] {
        register.pose(&pose(stamp * MS, &world_from_body(0)));
    }
    for stamp in [5, i64::MAX / MS, 15, 25] {
        register.profile(profile(stamp * MS));
    }
    let scans: Vec<Scan> = register.drain().collect();
    assert_eq!(scans.len(), 3);
    let refused = told(scans, register.finish());
    assert_eq!(refused.iter().map(|(_, count)| count).sum::<u64>(), 3, "{refused:?}");
    // A tracker whose clock was set back is believed at its second reading.
    let mut register = Register::new(Config::default(), &calibration(0)).unwrap();
    for stamp in [900_000, 900_010, 0, 10, 20] {
        register.pose(&pose(stamp * MS, &world_from_body(0)));
    }
    register.profile(profile(15 * MS));
    assert_eq!(register.drain().count(), 1);
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
