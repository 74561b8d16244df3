//! The readings come in order, without gaps in their count, with the phases of the hand, the same for the same seed.
#![allow(clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

use geometry::Rig;
use tracker_sim::{TrackerSim, TrackerSimError};
use wire::{Phase, codec};
use world::Scene;

fn rig() -> Rig {
    let path = format!("{}/../../config/rigs/paper.toml", env!("CARGO_MANIFEST_DIR"));
    Rig::parse(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn ball() -> Scene {
    Scene::parse("[[object]]\nkind = \"sphere\"\nsides_mm = [90, 90, 90]\n", "".as_ref()).unwrap()
}

fn sweep(seconds: f64, seed: u64) -> TrackerSim {
    TrackerSim::new(&ball(), &rig(), seconds, seed).unwrap()
}

#[test]
fn stamps_rise_and_the_count_has_no_gap() {
    let poses: Vec<_> = sweep(10.0, 3).collect();
    assert!(poses.windows(2).all(|pair| pair[0].header.stamp_nanos < pair[1].header.stamp_nanos));
    assert!(poses.iter().enumerate().all(|(i, pose)| pose.header.seq == i as u64));
    let (first, last) = (poses[0].header.stamp_nanos, poses[poses.len() - 1].header.stamp_nanos);
    assert!(first < 0 && last > 10_000_000_000, "poses before the first frame and behind the last: {first} to {last}");
}

#[test]
fn phases_are_the_hands_and_the_end_is_left_to_the_node() {
    let phases: Vec<Phase> = sweep(5.0, 3).map(|pose| pose.header.phase).collect();
    assert_eq!((phases[0], phases[phases.len() - 1]), (Phase::Aim, Phase::Both));
    let mut scene = ball();
    scene.hand.two_passes = true;
    let phases: Vec<Phase> = TrackerSim::new(&scene, &rig(), 5.0, 3).unwrap().map(|pose| pose.header.phase).collect();
    let count = |phase: Phase| phases.iter().filter(|p| **p == phase).count();
    assert!(count(Phase::Shape) > 200 && count(Phase::Colour) > 200 && count(Phase::Both) == 0);
}

#[test]
fn same_seed_same_bytes() {
    let bytes = |seed: u64| sweep(2.0, seed).map(|pose| codec::encode(&pose)).collect::<Vec<_>>();
    assert_eq!(bytes(1), bytes(1));
    assert_ne!(bytes(1), bytes(2));
}

#[test]
fn impossible_sweeps_are_refused() {
    assert!(matches!(TrackerSim::new(&ball(), &rig(), -1.0, 1), Err(TrackerSimError::Hand(_))));
    let mut rig = rig();
    rig.simulation = Some("tracker = { rate_hz = -3 }".parse().unwrap());
    let said = TrackerSim::new(&ball(), &rig, 5.0, 1).unwrap_err().to_string();
    assert!(said.contains("rate_hz"), "{said}");
}
