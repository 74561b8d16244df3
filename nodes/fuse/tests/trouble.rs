//! Receivers that are lost, wrong, silent or late: who is left out, and what is said of it.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

mod handset;

use fuse::{Config, Fuse, Receiver};
use handset::{MS, end, erring, error, fuse, on_arm, stamps_ms, triangle, true_reading};
use nalgebra::{Point3, Vector3};
use wire::{Clock, Header, Phase, Pose, Quality};

fn lost(pose: Pose) -> Pose {
    Pose { quality: Quality::Lost, reason: "out of range".into(), ..pose }
}

fn refused(fuse: &mut Fuse) -> Vec<(String, u64)> {
    fuse.take_refused().into_iter().map(|refusal| (refusal.reason, refusal.count)).collect()
}

/// Readings of some receivers every 10 ms, from and until some milliseconds.
fn feed(fuse: &mut Fuse, config: &Config, receivers: &[usize], ms: std::ops::Range<i64>) {
    for stamp in ms.step_by(10) {
        receivers.iter().for_each(|&receiver| fuse.pose(receiver, &true_reading(config, receiver, stamp * MS)));
    }
}

fn assert_true(poses: &[Pose]) {
    for pose in poses {
        let [off, turn] = error(pose);
        assert!(off.norm() < 1e-6 && turn.norm() < 1e-6, "{pose:?}");
    }
}

#[test]
fn one_that_is_lost_is_left_out_and_named_and_the_sigma_grows() {
    let config = triangle();
    let mut fuse = fuse(config.clone());
    feed(&mut fuse, &config, &[0, 1, 2], 0..100);
    for stamp in (100..300).step_by(10) {
        feed(&mut fuse, &config, &[0, 1], stamp..stamp + 1);
        fuse.pose(2, &lost(true_reading(&config, 2, stamp * MS)));
    }
    feed(&mut fuse, &config, &[0, 1, 2], 300..400);
    let fused: Vec<Pose> = fuse.drain().collect();
    assert_eq!(stamps_ms(&fused), (0..400).step_by(10).collect::<Vec<_>>(), "nothing is held up for good");
    assert_true(&fused);
    let without: Vec<&Pose> = fused.iter().filter(|pose| pose.quality == Quality::Degraded).collect();
    assert_eq!(without.len(), 20);
    assert!(without.iter().all(|pose| pose.reason == "right tells no pose around it"), "{}", without[0].reason);
    let sigma = |pose: &Pose| Vector3::from(pose.rotation_sigma_rad).norm();
    assert!(sigma(without[5]) > 1.2 * sigma(&fused[0]));
    let refused = refused(&mut fuse);
    assert!(refused.contains(&("right: moment without it: it tells no pose around it".into(), 20)), "{refused:?}");
    assert!(refused.contains(&("right: pose that the tracker calls lost".into(), 20)), "{refused:?}");
}

#[test]
fn where_the_first_tells_nothing_the_next_ones_readings_are_the_moments() {
    let config = triangle();
    let mut fuse = fuse(config.clone());
    for stamp in (0..500).step_by(10) {
        let first = true_reading(&config, 0, stamp * MS);
        fuse.pose(0, &if (100..300).contains(&stamp) { lost(first) } else { first });
        fuse.pose(1, &true_reading(&config, 1, (stamp + 4) * MS));
        fuse.pose(2, &true_reading(&config, 2, (stamp + 4) * MS));
    }
    let stamps = stamps_ms(&fuse.drain().collect::<Vec<_>>());
    let expected = (0..100).step_by(10).chain((94..300).step_by(10)).chain((300..500).step_by(10));
    let expected: Vec<i64> = expected.filter(|stamp| *stamp < 494).collect();
    assert_eq!(stamps, expected);
}

#[test]
fn when_all_are_lost_the_first_says_so() {
    let config = triangle();
    let mut fuse = fuse(config.clone());
    feed(&mut fuse, &config, &[0, 1, 2], 0..50);
    for stamp in (50..200).step_by(10) {
        (0..3).for_each(|receiver| fuse.pose(receiver, &lost(true_reading(&config, receiver, stamp * MS))));
    }
    let fused: Vec<Pose> = fuse.drain().collect();
    let told: Vec<&Pose> = fused.iter().filter(|pose| pose.quality == Quality::Lost).collect();
    assert_eq!((fused.len(), told.len()), (20, 15));
    assert!(["top", "left", "right"].iter().all(|name| told[0].reason.contains(name)), "{}", told[0].reason);
}

#[test]
fn an_outlier_is_left_out_and_told_with_how_far_it_is_off() {
    for (off, turn, said) in [
        (Vector3::new(0.0, 0.035, 0.0), Vector3::zeros(), "right is 35.0 mm and 0.0 degrees off the others"),
        (Vector3::zeros(), Vector3::new(0.0, 0.0, 0.5), "right is 0.0 mm and 28.6 degrees off the others"),
        (Vector3::zeros(), Vector3::new(3.1, 0.0, 0.0), "right is 0.0 mm and 177.6 degrees off the others"),
        (Vector3::new(1e300, 0.0, 0.0), Vector3::zeros(), "right is"),
    ] {
        let config = triangle();
        let mut fuse = fuse(config.clone());
        feed(&mut fuse, &config, &[0, 1], 0..1);
        fuse.pose(2, &erring(&config, 2, 0, off, turn));
        let fused: Vec<Pose> = fuse.drain().collect();
        assert_true(&fused);
        assert_eq!(fused[0].quality, Quality::Degraded);
        assert!(fused[0].reason.starts_with(said), "{}", fused[0].reason);
        assert_eq!(refused(&mut fuse), [("right: moment at which it is an outlier".to_owned(), 1)]);
    }
}

#[test]
fn two_outliers_of_five_are_found_and_two_of_four_are_no_minority() {
    let five = ["a", "b", "c", "d", "e"];
    let mounted = |count: usize| {
        let receivers = five[..count].iter().enumerate().map(|(i, name)| on_arm(name, 70.0 * i as f64)).collect();
        Config { receivers, ..triangle() }
    };
    let feed = |config: &Config| {
        let mut fuse = fuse(config.clone());
        for receiver in 0..config.receivers.len() {
            let off = if receiver < 2 { Vector3::new(0.02, 0.1 * receiver as f64, 0.0) } else { Vector3::zeros() };
            fuse.pose(receiver, &erring(config, receiver, 0, off, Vector3::zeros()));
        }
        fuse.drain().next().unwrap()
    };
    let found = feed(&mounted(5));
    assert_true(std::slice::from_ref(&found));
    assert!(found.reason.contains("a is") && found.reason.contains("b is"), "{}", found.reason);
    let contradiction = feed(&mounted(4));
    assert_eq!(contradiction.quality, Quality::Lost);
    assert!(contradiction.reason.contains("a, b, c, d are"), "{}", contradiction.reason);
}

#[test]
fn of_two_that_contradict_each_other_neither_is_believed() {
    let config = Config { receivers: triangle().receivers[..2].to_vec(), ..triangle() };
    let mut fuse = fuse(config.clone());
    feed(&mut fuse, &config, &[0], 0..1);
    fuse.pose(1, &erring(&config, 1, 0, Vector3::new(0.05, 0.0, 0.0), Vector3::zeros()));
    let told = fuse.drain().next().unwrap();
    assert_eq!(told.quality, Quality::Lost);
    assert!(told.reason.starts_with("top, left are") && told.reason.contains("cannot be told"), "{}", told.reason);
    assert_eq!(refused(&mut fuse), [("moment at which the receivers contradict each other".to_owned(), 1)]);
}

#[test]
fn a_silent_one_holds_the_others_up_no_longer_than_they_allow() {
    let config = triangle();
    let mut fuse = fuse(config.clone());
    feed(&mut fuse, &config, &[0, 1], 0..150);
    assert!(fuse.drain().next().is_none() && fuse.overdue().is_empty(), "its messages may be on their way");
    feed(&mut fuse, &config, &[0, 1], 150..250);
    assert_eq!(fuse.overdue(), [2], "200 ms have gone by");
    fuse.go_on_without(2);
    let fused: Vec<Pose> = fuse.drain().collect();
    assert_eq!((fused.len(), fused[0].reason.as_str()), (25, "right is silent"));
    assert!(fuse.is_silent(2) && fuse.overdue().is_empty());
    feed(&mut fuse, &config, &[0, 1], 250..300);
    assert_eq!(fuse.drain().count(), 5, "nobody waits for it any more");

    // What it says of moments that are gone comes too late; when it has caught up it is waited for again.
    feed(&mut fuse, &config, &[2], 200..280);
    assert!(fuse.is_silent(2));
    feed(&mut fuse, &config, &[2], 280..310);
    assert!(!fuse.is_silent(2));
    feed(&mut fuse, &config, &[0, 1], 300..330);
    let fused: Vec<Pose> = fuse.drain().collect();
    assert_eq!(stamps_ms(&fused), [300]);
    assert_eq!((fused[0].quality, fused[0].reason.as_str()), (Quality::Good, ""));
    let refused = refused(&mut fuse);
    assert!(refused.contains(&("right: pose that came too late".into(), 9)), "{refused:?}");
}

#[test]
fn the_end_comes_once_behind_all_that_can_end() {
    let config = triangle();
    let mut fuse = fuse(config.clone());
    feed(&mut fuse, &config, &[0, 1], 0..30);
    fuse.pose(0, &end(40 * MS));
    assert!(fuse.end().is_none() && fuse.overdue().is_empty());
    fuse.pose(1, &end(41 * MS));
    assert_eq!(fuse.overdue(), [2], "only the one that never spoke is left");
    fuse.go_on_without(2);
    let (header, evidence) = fuse.end().unwrap();
    assert_eq!((header.phase, header.stamp_nanos, header.scan), (Phase::End, 41 * MS, 1));
    assert_eq!((evidence.fused, evidence.good, evidence.lost), (3, 0, 0));
    assert_eq!(fuse.drain().count(), 3);
    assert!(fuse.end().is_none(), "told once");
    feed(&mut fuse, &config, &[2], 0..10);
    assert_eq!(fuse.drain().count(), 0);
    assert!(refused(&mut fuse).contains(&("right: pose behind the end of its scan".into(), 1)));

    // The next scan starts afresh.
    for receiver in 0..3 {
        let pose = true_reading(&config, receiver, 0);
        fuse.pose(receiver, &Pose { header: Header { scan: 2, ..pose.header }, ..pose });
    }
    let fused: Vec<Pose> = fuse.drain().collect();
    assert_eq!((fused.len(), fused[0].header.scan, fused[0].quality), (1, 2, Quality::Good));
    feed(&mut fuse, &config, &[0], 0..10);
    assert_eq!(refused(&mut fuse), [("top: pose of an older scan".to_owned(), 1)]);
}

#[test]
fn what_waits_when_the_next_scan_begins_is_fused_by_what_has_come() {
    let config = triangle();
    let mut fuse = fuse(config.clone());
    feed(&mut fuse, &config, &[0, 1], 0..30);
    let next = true_reading(&config, 0, 0);
    fuse.pose(0, &Pose { header: Header { scan: 2, ..next.header }, ..next });
    assert_eq!(fuse.drain().map(|pose| pose.header.scan).collect::<Vec<_>>(), [1, 1, 1]);
}

#[test]
fn bad_readings_are_counted_by_receiver_and_reason() {
    let config = Config { use_degraded: false, ..triangle() };
    let mut fuse = fuse(config.clone());
    let good = |ms: i64| true_reading(&config, 1, ms * MS);
    let mut nan = good(20);
    nan.world_from_body.translation_m[1] = f64::NAN;
    let on_another_clock = Pose { header: Header { clock: Clock::System, ..good(55).header }, ..good(55) };
    for pose in [
        good(10),
        nan,
        Pose { position_sigma_m: [1e-3, -1.0, 1e-3], ..good(30) },
        Pose { quality: Quality::Degraded, ..good(40) },
        Pose { rotation_lag_nanos: i64::MIN, ..good(50) },
        on_another_clock,
        good(50),
        // A lone stamp far ahead shuts nobody out.
        good(3_600_000),
        good(60),
    ] {
        fuse.pose(1, &pose);
    }
    fuse.pose(7, &good(70));
    let expected = [
        ("left: pose on another clock than the first", 1),
        ("left: pose that is no rigid transform or has no sigma", 2),
        ("left: pose that the tracker calls degraded", 1),
        ("left: pose whose rotation is more than a second from its position", 1),
        ("left: pose whose time goes backwards", 1),
        ("left: pose whose time is far ahead of the one before", 1),
        ("pose of a receiver that is not configured", 1),
    ];
    assert_eq!(refused(&mut fuse), expected.map(|(reason, count)| (reason.to_owned(), count)));
}

#[test]
fn a_degraded_reading_is_used_with_its_sigma_and_said() {
    let config = triangle();
    let mut fuse = fuse(config.clone());
    feed(&mut fuse, &config, &[0, 1], 0..1);
    let reason = "metal is near".to_owned();
    let sigmas = ([0.1; 3], [1.0; 3]);
    let bent = Vector3::new(0.05, 0.0, 0.0);
    fuse.pose(
        2,
        &Pose {
            quality: Quality::Degraded,
            reason,
            position_sigma_m: sigmas.0,
            rotation_sigma_rad: sigmas.1,
            ..erring(&config, 2, 0, bent, Vector3::zeros())
        },
    );
    let fused = fuse.drain().next().unwrap();
    assert_eq!((fused.quality, fused.reason.as_str()), (Quality::Degraded, "right is degraded: metal is near"));
    let [off, _] = error(&fused);
    assert!(off.norm() < 1e-4, "what is so unsure weighs nothing: {off}");
}

#[test]
fn receivers_that_cannot_be_are_refused() {
    let two = triangle().receivers[..2].to_vec();
    let twice = vec![two[0].clone(), two[0].clone()];
    let turned = Receiver { rotation_wxyz: [0.0; 4], ..two[0].clone() };
    let far = Receiver { translation_m: [100.0, 0.0, 0.0], ..two[0].clone() };
    let nameless = Receiver { tracker: "tracker/left".into(), ..two[0].clone() };
    let with = |receivers| Config { receivers, ..Config::default() };
    for (config, named) in [
        (Config::default(), "receivers = 0 of them"),
        (with(twice), "name each once"),
        (with(vec![turned]), "unit quaternion"),
        (with(vec![far]), "on a handset"),
        (with(vec![nameless]), "tracker/left"),
        (Config { most_wait_ms: f64::NAN, ..with(two.clone()) }, "most_wait_ms"),
        (Config { most_gap_ms: 0.0, ..with(two.clone()) }, "most_gap_ms"),
        (Config { apart_mm: -1.0, ..with(two.clone()) }, "apart_mm"),
        (Config { apart_deg: f64::INFINITY, ..with(two.clone()) }, "apart_deg"),
        (Config { outlier_sigmas: 1.0, ..with(two) }, "outlier_sigmas"),
    ] {
        let said = Fuse::new(config).unwrap_err().to_string();
        assert!(said.contains(named), "{said}");
    }
    let unknown = serde_json::json!({ "receivers": [{ "tracker": "a", "translation_mm": [0, 0, 0] }] });
    assert!(serde_json::from_value::<Config>(unknown).unwrap_err().to_string().contains("translation_mm"));
    let short = serde_json::json!({ "receivers": [{ "tracker": "a" }] });
    let short = serde_json::from_value::<Config>(short).unwrap();
    assert_eq!(short.receivers[0].body_from_receiver().unwrap() * Point3::origin(), Point3::origin());
}
