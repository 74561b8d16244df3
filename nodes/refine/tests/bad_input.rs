//! What a scan should not be: each is refused with a count, or told as a notice; nothing panics and nothing is worse than
//! the smoothed tracker.

#![allow(clippy::unwrap_used, reason = "tests")]

mod handset;

use handset::{Sweep, calibration, told};
use proptest::prelude::*;
use refine::{Config, Notice, RefineError, Refinement, Refiner};
use wire::{Phase, Quality};

/// Root mean square height of the points over the table z = 0, in millimetres, and of the plane fitted to them.
fn roughness_mm(refinement: &Refinement) -> f64 {
    let heights: Vec<f64> =
        refinement.scans().flat_map(|s| s.points.0).map(|p| f64::from(p.position_m[2]) * 1e3).collect();
    (heights.iter().map(|h| h * h).sum::<f64>() / heights.len() as f64).sqrt()
}

fn refused(refinement: &Refinement, reason: &str) -> u64 {
    let found = refinement.evidence.refused.iter().find(|r| r.reason.contains(reason));
    found.map_or(0, |refused| refused.count)
}

#[test]
fn without_anything_there_is_an_error_that_says_what_is_missing() {
    let empty = Refiner::new(Config::default(), &calibration()).unwrap();
    assert!(matches!(empty.finish(), Err(RefineError::Tracker(_))));
    let mut empty = empty;
    assert!(empty.tick().is_none());
    let only_poses = told(&Sweep::default().poses(), &[]);
    assert_eq!(only_poses.finish().err(), Some(RefineError::NoFrames { frames: 0 }));
}

#[test]
fn a_configuration_that_cannot_be_is_refused_by_name() {
    let config = Config { knot_ms: f64::NAN, ..Config::default() };
    let error = Refiner::new(config, &calibration()).err().unwrap().to_string();
    assert!(error.contains("knot_ms"), "{error}");
    let mut crooked = calibration();
    crooked.body_from_camera.rotation_wxyz = [0.0; 4];
    assert!(matches!(Refiner::new(Config::default(), &crooked), Err(RefineError::HandEye(_))));
}

#[test]
fn a_plane_is_made_flat_and_said_to_hold_no_sliding() {
    let refinement = Sweep::default().refiner().finish().unwrap();
    let e = &refinement.evidence;
    assert_eq!(e.observed.unwrap().held_directions, 3);
    assert!(e.notices.iter().any(|n| matches!(n, Notice::SurfaceHoldsLittle { held_directions: 3, .. })));
    assert!(e.residual.after_mm <= e.residual.before_mm);
    assert!(roughness_mm(&refinement) < 0.5, "{}", roughness_mm(&refinement));
}

#[test]
fn a_table_is_used_when_it_is_flat_and_a_dish_is_not_taken_for_one() {
    let on_table = |dish_m: Option<f64>| {
        let sweep = Sweep { steps_m: 0.02, dish_m, ..Sweep::default() };
        sweep.refiner().finish().unwrap().evidence.frames_on_table
    };
    assert!(on_table(None) > 500, "{}", on_table(None));
    // Over the 6 cm of a stripe these rise by 0.45 and 0.09 mm.
    assert_eq!(on_table(Some(1.0)), 0);
    assert_eq!(on_table(Some(5.0)), 0);
}

#[test]
fn one_stripe_gives_the_smoothed_tracker_and_says_so() {
    let sweep = Sweep { seconds: 6.0, single: true, steps_m: 0.003, ..Sweep::default() };
    let mut poses = sweep.poses();
    let profiles: Vec<_> = sweep.profiles().into_iter().take(1).collect();
    let one = told(&poses, &profiles).finish().unwrap();
    assert_eq!(one.scans().len(), 1);
    assert_eq!(one.evidence.notices.first(), Some(&Notice::NothingSeenTwice));
    let stroke = told(&poses, &sweep.profiles()).finish().unwrap();
    assert_eq!(stroke.evidence.notices.first(), Some(&Notice::NothingSeenTwice));
    assert!(roughness_mm(&stroke) < 5.0);
    poses.truncate(3);
    assert!(told(&poses, &profiles).finish().is_err());
}

#[test]
fn strokes_that_do_not_cross_hold_the_hand_eye_and_name_the_missing_one() {
    let sweep = Sweep { crossing: false, steps_m: 0.003, ..Sweep::default() };
    let refinement = sweep.refiner().finish().unwrap();
    let e = &refinement.evidence;
    assert!(!e.hand_eye.freed);
    assert_eq!(e.hand_eye.shift_mm, [0.0; 3]);
    let advice = e.notices.iter().find_map(|notice| match notice {
        Notice::StrokesDoNotCross { advice, .. } => Some(advice.clone()),
        _ => None,
    });
    assert!(advice.unwrap().contains("along (0.00, 1.00, 0.00)") || e.observed.unwrap().stripes_along[1].abs() > 0.99);
    let crossing = Sweep { steps_m: 0.003, ..Sweep::default() }.refiner().finish().unwrap();
    assert!(crossing.evidence.hand_eye.freed && crossing.evidence.observed.unwrap().crossing > 0.5);
}

#[test]
fn frames_while_the_tracker_is_silent_have_no_pose_and_are_counted() {
    let sweep = Sweep { steps_m: 0.003, ..Sweep::default() };
    let silent = 9_000_000_000..12_000_000_000;
    let poses: Vec<_> = sweep.poses().into_iter().filter(|p| !silent.contains(&p.header.stamp_nanos)).collect();
    let refinement = told(&poses, &sweep.profiles()).finish().unwrap();
    let e = &refinement.evidence;
    assert_eq!(e.frames_without_pose, 75);
    assert_eq!(e.frames_kept + e.dropped.len() + 75, 600);
    let margin = 20_000_000;
    let inside = |t: i64| t > silent.start + margin && t < silent.end - margin;
    assert!(refinement.trajectory.iter().all(|pose| !inside(pose.stamp_nanos)));
}

#[test]
fn what_does_not_belong_is_refused_and_counted() {
    let sweep = Sweep { seconds: 8.0, steps_m: 0.003, ..Sweep::default() };
    let (mut poses, mut profiles) = (sweep.poses(), sweep.profiles());
    let clean = told(&poses, &profiles).finish().unwrap();
    // Another scan, time that goes backwards, a lone stamp far ahead, NaN, a lost reading, an aimed frame, bad points.
    let mut other = profiles[10].clone();
    other.header.scan = 9;
    let backwards = profiles[20].clone();
    let mut aimed = profiles[40].clone();
    aimed.header.phase = Phase::Aim;
    aimed.header.stamp_nanos += 1;
    let mut far = poses[400].clone();
    far.header.stamp_nanos += 1_000_000_000_000;
    let mut lost = poses[500].clone();
    (lost.quality, lost.header.stamp_nanos) = (Quality::Lost, lost.header.stamp_nanos + 1);
    let mut nan = lost.clone();
    (nan.quality, nan.world_from_body.translation_m[1]) = (Quality::Good, f64::NAN);
    let late = poses[3].clone();
    let mut bad_points = profiles[50].clone();
    bad_points.header.stamp_nanos += 2;
    bad_points.points.0.truncate(2);
    bad_points.points[0].position_m[0] = f32::NAN;
    bad_points.points[1].position_m[2] = -0.2;
    profiles.insert(60, bad_points);
    profiles.insert(51, aimed);
    profiles.insert(41, backwards);
    profiles.insert(31, other);
    poses.insert(501, nan);
    poses.insert(501, lost);
    poses.insert(301, far);
    poses.insert(101, late);
    // The bad points' frame comes too late for the order: its stamp lies before its neighbours'.
    let dirty = told(&poses, &profiles).finish().unwrap();
    assert_eq!(refused(&dirty, "another scan"), 1);
    assert_eq!(refused(&dirty, "profile whose time goes backwards"), 2);
    assert_eq!(refused(&dirty, "pose whose time goes backwards"), 1);
    assert_eq!(refused(&dirty, "far from the one before"), 1);
    assert_eq!(refused(&dirty, "calls lost"), 1);
    assert_eq!(refused(&dirty, "no rigid transform"), 1);
    assert_eq!(refused(&dirty, "aiming"), 1);
    assert_eq!(clean.trajectory, dirty.trajectory);
    assert!(clean.scans().eq(dirty.scans()));
}

#[test]
fn rotations_that_are_older_than_their_positions_are_taken_at_their_own_moment() {
    let sweep = Sweep { seconds: 12.0, steps_m: 0.003, ..Sweep::default() };
    let lag = 20_000_000;
    let poses = sweep.poses();
    let mut lagging = poses.clone();
    for i in 2..poses.len() {
        lagging[i].world_from_body.rotation_wxyz = poses[i - 2].world_from_body.rotation_wxyz;
        lagging[i].rotation_lag_nanos = lag;
    }
    let refinement = told(&lagging[2..], &sweep.profiles()).finish().unwrap();
    assert!(refinement.evidence.residual.after_mm < 0.1, "{:?}", refinement.evidence.residual);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn nothing_panics_on_hostile_messages(seed in any::<u64>(), bytes in prop::collection::vec(any::<u32>(), 600)) {
        let sweep = Sweep { seconds: 3.0, steps_m: 0.003, ..Sweep::default() };
        let (mut poses, mut profiles) = (sweep.poses(), sweep.profiles());
        for (i, word) in bytes.iter().enumerate() {
            let (pose, profile) = (&mut poses[*word as usize % 300], &mut profiles[*word as usize % 70]);
            let value = f64::from_bits(seed.wrapping_mul(u64::from(*word) | 1).rotate_left(i as u32));
            match i % 7 {
                0 => pose.world_from_body.translation_m[i % 3] = value,
                1 => pose.world_from_body.rotation_wxyz[i % 4] = value,
                2 => pose.header.stamp_nanos = value as i64,
                3 => pose.position_sigma_m[i % 3] = value,
                4 => profile.points[i % 100].position_m[i % 3] = value as f32,
                5 => profile.points[i % 100].range_sigma_m = value as f32,
                _ => profile.header.stamp_nanos = profile.header.stamp_nanos.wrapping_add(value as i64 % 1_000_000_000),
            }
        }
        let mut refiner = told(&poses, &profiles);
        let _ = refiner.tick();
        if let Ok(refinement) = refiner.finish() {
            let finite = |p: &wire::ScanPoint| p.position_m.iter().all(|x| x.is_finite()) && p.sigma_m.is_finite();
            prop_assert!(refinement.scans().all(|scan| scan.points.iter().all(finite)));
        }
    }
}
