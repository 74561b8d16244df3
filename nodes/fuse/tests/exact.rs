//! Without noise the fused pose is the true one, whenever and however the readings come.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

mod handset;

use fuse::{Config, Receiver};
use handset::{MS, end, error, fuse, reading, stamps_ms, triangle, true_reading, world_from_body};
use wire::{Pose, Quality, RigidPose};

#[test]
fn three_receivers_on_a_known_way_give_that_way() {
    let config = triangle();
    let mut fuse = fuse(config.clone());
    for step in 0..50 {
        (0..3).for_each(|receiver| fuse.pose(receiver, &true_reading(&config, receiver, step * 10 * MS)));
    }
    let fused: Vec<Pose> = fuse.drain().collect();
    assert_eq!(stamps_ms(&fused), (0..50).map(|step| step * 10).collect::<Vec<_>>());
    for pose in &fused {
        let [off, turn] = error(pose);
        assert!(off.norm() < 1e-9 && turn.norm() < 1e-9, "{off} {turn}");
        assert_eq!((pose.quality, pose.reason.as_str(), pose.rotation_lag_nanos), (Quality::Good, "", 0));
        assert_eq!(pose.header.scan, 1);
    }
    assert_eq!(fuse.take_refused(), vec![]);
}

#[test]
fn each_receiver_is_taken_at_its_own_moments_and_its_rotation_too() {
    let config = triangle();
    let mut fuse = fuse(config.clone());
    let lags = [0, 7 * MS, 3 * MS];
    for step in 0..50 {
        for (receiver, lag) in lags.into_iter().enumerate() {
            let stamp = step * 10 * MS + receiver as i64 * 3 * MS;
            let mut pose = true_reading(&config, receiver, stamp);
            let older = true_reading(&config, receiver, stamp - lag);
            pose.world_from_body.rotation_wxyz = older.world_from_body.rotation_wxyz;
            pose.rotation_lag_nanos = lag;
            fuse.pose(receiver, &pose);
        }
    }
    let fused: Vec<Pose> = fuse.drain().collect();
    // The first receiver's readings, but for the last of which not all have told.
    assert_eq!(stamps_ms(&fused), (0..49).map(|step| step * 10).collect::<Vec<_>>());
    assert_eq!(fused.iter().filter(|pose| pose.quality == Quality::Good).count(), 48, "the others begin 3 ms later");
    for pose in &fused {
        let [off, turn] = error(pose);
        // A receiver on an arm that turns moves on an arc, of which the straight line between readings misses so much.
        assert!(off.norm() < 1e-6 && turn.norm() < 5e-6, "{off} {turn}");
    }
}

#[test]
fn a_single_receiver_passes_through_unchanged() {
    let config = Config {
        receivers: vec![Receiver { tracker: "only".into(), ..triangle().receivers[0].clone() }],
        ..Config::default()
    };
    let at_origin = Receiver {
        translation_m: RigidPose::IDENTITY.translation_m,
        rotation_wxyz: RigidPose::IDENTITY.rotation_wxyz,
        ..config.receivers[0].clone()
    };
    let mut fuse = fuse(Config { receivers: vec![at_origin], ..config });
    for step in 0..20 {
        let given = reading(step * 10 * MS, &world_from_body(step * 10 * MS));
        fuse.pose(0, &given);
        let fused = fuse.drain().next().unwrap();
        assert_eq!((fused.header, fused.quality, &fused.reason), (given.header, given.quality, &given.reason));
        let numbers = |pose: &Pose| {
            let RigidPose { translation_m, rotation_wxyz } = pose.world_from_body;
            let sigmas = pose.position_sigma_m.into_iter().chain(pose.rotation_sigma_rad);
            translation_m.into_iter().chain(rotation_wxyz).chain(sigmas).collect::<Vec<f64>>()
        };
        for (found, wanted) in numbers(&fused).iter().zip(numbers(&given)) {
            assert!((found - wanted).abs() < 1e-15, "{found} {wanted}");
        }
    }
}

#[test]
fn a_single_receiver_on_an_arm_is_moved_to_the_body_with_the_error_of_the_arm() {
    let config = Config { receivers: triangle().receivers[..1].to_vec(), ..Config::default() };
    let mut fuse = fuse(config.clone());
    fuse.pose(0, &true_reading(&config, 0, 0));
    let fused = fuse.drain().next().unwrap();
    let [off, turn] = error(&fused);
    assert!(off.norm() < 1e-12 && turn.norm() < 1e-12);
    // 0.03 rad on 0.1 m are 3 mm across the arm, in two directions; along it 1 mm stays.
    let variance: f64 = fused.position_sigma_m.iter().map(|sigma| sigma * sigma).sum();
    assert!((variance - (3.0 * 1e-6 + 2.0 * 9e-6)).abs() < 1e-12, "{variance}");
    assert!(fused.rotation_sigma_rad.iter().all(|sigma| (sigma - 0.03).abs() < 1e-12));
}

#[test]
fn it_does_not_matter_in_which_batches_the_messages_come() {
    let config = triangle();
    let readings: Vec<Vec<Pose>> = (0..3)
        .map(|receiver| {
            let stamps = (0..200).map(|step| step * 10 * MS + receiver as i64 * 2 * MS);
            // Each is silent for a while, the first one too.
            let silence = 300 * MS * (1 + receiver as i64);
            let told = stamps.filter(|stamp| !(silence..silence + 150 * MS).contains(stamp));
            told.map(|stamp| true_reading(&config, receiver, stamp)).chain([end(2100 * MS)]).collect()
        })
        .collect();
    let mut one_by_one = fuse(config.clone());
    let mut order: Vec<(i64, usize, &Pose)> = Vec::new();
    for (receiver, poses) in readings.iter().enumerate() {
        order.extend(poses.iter().map(|pose| (pose.header.stamp_nanos, receiver, pose)));
    }
    order.sort_by_key(|(stamp, receiver, _)| (*stamp, *receiver));
    order.iter().for_each(|(_, receiver, pose)| one_by_one.pose(*receiver, pose));
    let mut all_of_one_first = fuse(config);
    for receiver in [1, 2, 0] {
        readings[receiver].iter().for_each(|pose| all_of_one_first.pose(receiver, pose));
    }
    let [a, b] = [&mut one_by_one, &mut all_of_one_first].map(|fuse| fuse.drain().collect::<Vec<Pose>>());
    assert!(a.len() > 190, "{}", a.len());
    assert_eq!(a, b);
    assert_eq!(one_by_one.end(), all_of_one_first.end());
}
