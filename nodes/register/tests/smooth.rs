//! A hand that is known exactly and a tracker as noisy as the paper's: what the smooth way gains, and that it is the same
//! however messages come.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use register::{Config, Register};
use wire::*;

const MS: i64 = 1_000_000;

fn header(stamp_nanos: i64) -> Header {
    Header { scan: 1, stamp_nanos, phase: Phase::Shape, ..Header::default() }
}

fn world_from_body(stamp_nanos: i64) -> Isometry3<f64> {
    let t = stamp_nanos as f64 * 1e-9;
    let sway = |hz: f64, phase: f64| (std::f64::consts::TAU * hz * t + phase).sin();
    let place =
        Vector3::new(0.05 * t, 3e-3 * sway(0.9, 0.0), 0.3) + Vector3::new(0.2e-3, -0.1e-3, 0.1e-3) * sway(9.0, 1.0);
    let turn = Vector3::new(0.02 * sway(1.3, 0.5), 0.3 * t, 0.02 * sway(0.7, 2.0));
    Isometry3::from_parts(Translation3::from(place), UnitQuaternion::new(turn))
}

fn calibration() -> Calibration {
    let camera =
        CameraIntrinsics { width: 640, height: 480, fx: 800.0, fy: 800.0, cx: 320.0, cy: 240.0, distortion: [0.0; 5] };
    let laser =
        LaserPlane { normal: [-0.8, 0.0, 0.6], distance_m: 0.1, channel_weights: [1.0; 3], peaks_per: PeaksPer::Row };
    let body_from_camera = RigidPose::IDENTITY;
    Calibration {
        header: Header::default(),
        camera,
        laser,
        body_from_camera,
        pose_offset_nanos: 0,
        name: String::new(),
    }
}

/// Gaussian by the sum of twelve, from a Weyl sequence scrambled by a multiplier.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    move || (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

/// White, 1.5 mm and 3 degrees as lengths of vectors, at 100 Hz; `lag_nanos` is the age of the rotation.
fn poses(seconds: i64, seed: u64, lag_nanos: i64) -> Vec<Pose> {
    noisy(seconds, seed, lag_nanos, [1.5e-3 / 3f64.sqrt(), 3f64.to_radians() / 3f64.sqrt()])
}

/// White noise of this size on each axis, in metres and radians.
fn noisy(seconds: i64, seed: u64, lag_nanos: i64, [position, rotation]: [f64; 2]) -> Vec<Pose> {
    let mut noise = noise(seed);
    let mut vector = |size: f64| Vector3::new(noise(), noise(), noise()) * size;
    let pose = |i: i64| {
        let stamp = i * 10 * MS;
        let place = world_from_body(stamp).translation.vector + vector(position);
        let turn = world_from_body(stamp - lag_nanos).rotation * UnitQuaternion::new(vector(rotation));
        Pose {
            header: header(stamp),
            world_from_body: geometry::rigid_to_wire(&Isometry3::from_parts(Translation3::from(place), turn)),
            position_sigma_m: [position; 3],
            rotation_sigma_rad: [rotation; 3],
            rotation_lag_nanos: lag_nanos,
            quality: Quality::Good,
            reason: String::new(),
        }
    };
    (0..seconds * 100).map(pose).collect()
}

fn profile(stamp_nanos: i64) -> Profile {
    let point = ProfilePoint { position_m: [0.0, 0.0, 0.2], range_sigma_m: 1e-4, ..Default::default() };
    Profile { header: header(stamp_nanos), points: vec![point].into(), refused: vec![] }
}

fn profiles(seconds: i64) -> Vec<Profile> {
    (0..seconds * 60 - 60).map(|i| profile(5 * MS + i * 16_666_667)).collect()
}

/// How far poses are off: rms of the vectors in mm and degrees.
fn rms<'a>(found: impl Iterator<Item = (i64, &'a RigidPose)>) -> (f64, f64) {
    let (mut position, mut rotation, mut count) = (0.0, 0.0, 0.0);
    for (stamp, pose) in found {
        let (truth, found) = (world_from_body(stamp), geometry::rigid_from_wire(pose).unwrap());
        position += (found.translation.vector - truth.translation.vector).norm_squared();
        rotation += found.rotation.angle_to(&truth.rotation).powi(2);
        count += 1.0;
    }
    ((position / count * 1e6_f64).sqrt(), (rotation / count).sqrt().to_degrees())
}

/// What a scan and the way say; refusals travel with whatever comes next, so they are not compared.
type Told = (Vec<(i64, RigidPose, f64, f64)>, Vec<TrajectorySample>);

fn told(register: &mut Register, all: &mut Told) {
    all.0.extend(
        register.drain().map(|s| (s.header.stamp_nanos, s.world_from_camera, s.position_sigma_m, s.rotation_sigma_rad)),
    );
    while let Some(way) = register.trajectory() {
        all.1.extend(way.samples.iter().copied());
    }
}

fn register(config: Config, poses: &[Pose], profiles: &[Profile]) -> Told {
    let mut register = Register::new(config, &calibration()).unwrap();
    let mut all = Told::default();
    poses.iter().for_each(|pose| register.pose(pose));
    profiles.iter().for_each(|profile| register.profile(profile.clone()));
    told(&mut register, &mut all);
    register.finish();
    told(&mut register, &mut all);
    all
}

#[test]
fn the_live_picture_is_steadier_than_the_tracker() {
    let mut before = (f64::INFINITY, f64::INFINITY);
    let straight = Config { smooth: false, ..Config::default() };
    let lagging = |smooth_lag_ms| Config { smooth_lag_ms, ..Config::default() };
    for (name, config) in
        [("straight", straight), ("smooth", Config::default()), ("20 ms", lagging(20.0)), ("100 ms", lagging(100.0))]
    {
        let (scans, way) = register(config, &poses(30, 7, 0), &profiles(30));
        assert_eq!((scans.len(), way.len()), (1740, 3000));
        let found = rms(scans.iter().map(|(stamp, pose, ..)| (*stamp, pose)));
        let way: Vec<(i64, RigidPose)> = way
            .iter()
            .map(|s| (s.stamp_nanos, RigidPose { translation_m: s.translation_m, rotation_wxyz: s.rotation_wxyz }))
            .collect();
        let way = rms(way.iter().map(|(stamp, pose)| (*stamp, pose)));
        println!("{name}: profiles {found:.3?}, way {way:.3?} mm, degrees");
        assert!(found.0 < 0.97 * before.0 && found.1 < 0.97 * before.1);
        assert!(name == "straight" || way.0 < 0.6 && way.1 < 1.0);
        before = found;
    }
}

#[test]
fn a_tracker_that_errs_by_nothing_is_taken_at_its_word() {
    for noise in [0.0, 1e-9, 1e-7, 1e-6, 1e-5, 2e-5, 5e-5, 1e-4] {
        let (scans, way) = register(Config::default(), &noisy(10, 7, 0, [noise; 2]), &profiles(10));
        assert_eq!((scans.len(), way.len()), (540, 1000), "of noise {noise} every profile has its pose");
        let (position_mm, rotation_deg) = rms(scans.iter().map(|(stamp, pose, ..)| (*stamp, pose)));
        println!("{noise}: {position_mm:.5} mm, {rotation_deg:.6} degrees");
        assert!(
            position_mm < 0.02 + 2e3 * noise && rotation_deg < 0.01 + 100.0 * noise,
            "{position_mm}, {rotation_deg}"
        );
    }
}

#[test]
fn a_profile_of_a_noisy_tracker_need_not_wait() {
    let mut register = Register::new(Config::default(), &calibration()).unwrap();
    poses(3, 1, 0).iter().for_each(|pose| register.pose(pose));
    // 3 ms behind the last reading, and half a second.
    register.profile(profile(2993 * MS));
    register.profile(profile(3500 * MS));
    let scan = register.drain().next().unwrap();
    assert!(scan.position_sigma_m < 1.5e-3 / 3f64.sqrt() && scan.rotation_sigma_rad < 0.03);
    assert_eq!(register.finish().iter().map(|refusal| refusal.count).sum::<u64>(), 1);
}

#[test]
fn a_lag_that_the_end_cuts_short_loses_no_profile() {
    let config = Config { smooth_lag_ms: 100.0, ..Config::default() };
    let mut register = Register::new(config, &calibration()).unwrap();
    poses(3, 1, 0).iter().for_each(|pose| register.pose(pose));
    (0..10).for_each(|i| register.profile(profile((2850 + 15 * i) * MS)));
    assert_eq!(register.drain().count(), 3);
    assert_eq!(register.finish(), []);
    assert_eq!(register.drain().count(), 7);
}

#[test]
fn bounds_that_cannot_be_are_refused() {
    for config in [
        Config { smooth_lag_ms: -1.0, ..Config::default() },
        Config { smooth_lag_ms: 300.0, ..Config::default() },
        Config { predict_ms: f64::NAN, ..Config::default() },
        Config { most_gap_ms: 0.5, ..Config::default() },
    ] {
        assert!(config.check().is_err() && Register::new(config, &calibration()).is_err());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]
    #[test]
    fn batches_and_orders_make_no_difference(
        seed in any::<u64>(),
        lag_ms in 0..60i64,
        steps in proptest::collection::vec((any::<bool>(), 1..40usize, any::<bool>()), 40),
    ) {
        let (poses, profiles) = (poses(4, seed, lag_ms % 3 * 8 * MS), profiles(4));
        let config = Config { smooth_lag_ms: (lag_ms / 20 * 20) as f64, ..Config::default() };
        let at_once = register(config.clone(), &poses, &profiles);
        let mut register = Register::new(config, &calibration()).unwrap();
        let (mut poses, mut profiles, mut all) = (poses.iter(), profiles.into_iter(), Told::default());
        for (is_pose, count, tell) in steps {
            if is_pose {
                poses.by_ref().take(count).for_each(|pose| register.pose(pose));
            } else {
                profiles.by_ref().take(count).for_each(|profile| register.profile(profile));
            }
            if tell {
                told(&mut register, &mut all);
            }
        }
        poses.for_each(|pose| register.pose(pose));
        profiles.for_each(|profile| register.profile(profile));
        register.finish();
        told(&mut register, &mut all);
        prop_assert_eq!(all, at_once);
    }
}
