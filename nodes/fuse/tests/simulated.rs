//! Three receivers of the simulated tracker, on the simulated hand: the paper's first idea for better orientation.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

mod handset;

use fuse::{Config, Fuse};
use geometry::{Rig, TransformSection, rigid_from_wire};
use handset::{NAMES, triangle};
use nalgebra::Isometry3;
use tracker_sim::TrackerSim;
use wire::Pose;
use world::{Hand, Scene};

const SECONDS: f64 = 30.0;
const SEED: u64 = 1;

/// The paper's handset; `changes` overrule what its tracker does wrong.
fn rig(changes: &[(&str, f64)]) -> Rig {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/rigs/paper.toml");
    let mut rig = Rig::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    let tracker = rig.simulation.as_mut().unwrap()["tracker"].as_table_mut().unwrap();
    for (key, value) in changes.iter().chain(&[("filter_rest_s", 0.0), ("filter_moving_s", 0.0)]) {
        tracker.insert((*key).to_owned(), (*value).into());
    }
    rig
}

/// Errors of poses of the body: millimetres and degrees, root mean square.
fn errors(rig: &Rig, poses: &[Pose]) -> [f64; 2] {
    let hand = Hand::new(&Scene::cow().unwrap(), rig, SECONDS, SEED).unwrap();
    let mut sums = [0.0; 2];
    for pose in poses {
        let truth = hand.world_from_body(pose.header.stamp_nanos as f64 * 1e-9 + rig.clock.pose_offset_s);
        let said: Isometry3<f64> = rigid_from_wire(&pose.world_from_body).unwrap();
        sums[0] += (said.translation.vector - truth.translation.vector).norm_squared() * 1e6;
        sums[1] += said.rotation.angle_to(&truth.rotation).to_degrees().powi(2);
    }
    sums.map(|sum| (sum / poses.len() as f64).sqrt())
}

/// One receiver at the body's frame, and three on arms of 10 cm.
fn one_and_three(rig: &Rig, config: Config) -> ([f64; 2], [f64; 2]) {
    let scene = Scene::cow().unwrap();
    let alone: Vec<Pose> = TrackerSim::new(&scene, rig, SECONDS, SEED).unwrap().collect();
    let mut fuse = Fuse::new(config.clone()).unwrap();
    let mut last = 0;
    for (index, (receiver, name)) in config.receivers.iter().zip(NAMES).enumerate() {
        let place = TransformSection { translation_m: receiver.translation_m, rotation_wxyz: receiver.rotation_wxyz };
        for pose in TrackerSim::receiver(&scene, rig, SECONDS, SEED, &place, name).unwrap() {
            last = last.max(pose.header.stamp_nanos);
            fuse.pose(index, &pose);
        }
    }
    (0..3).for_each(|receiver| {
        fuse.pose(
            receiver,
            &Pose { header: wire::Header { scan: 0, ..handset::end(last + 1).header }, ..handset::end(0) },
        )
    });
    let fused: Vec<Pose> = fuse.drain().filter(|pose| pose.quality != wire::Quality::Lost).collect();
    let (_, evidence) = fuse.end().unwrap();
    assert!(fused.len() as f64 > 0.99 * alone.len() as f64, "{} of {}", fused.len(), alone.len());
    println!("{} poses, {:.2} times as far apart as stated", fused.len(), evidence.times_apart().unwrap());
    (errors(rig, &alone), errors(rig, &fused))
}

#[test]
fn three_degrees_of_noise_become_six_tenths() {
    let rig = rig(&[("field_position_mm", 0.0), ("field_rotation_deg", 0.0)]);
    let (one, three) = one_and_three(&rig, triangle());
    println!("noise alone: {one:.2?} mm, degrees with one receiver, {three:.2?} with three");
    assert!((one[1] - 3.0).abs() < 0.1 && three[1] < 0.65, "{one:?} {three:?}");
    assert!(three[0] < 0.65 * one[0], "{one:?} {three:?}");
}

#[test]
fn what_the_room_does_to_all_of_them_stays() {
    let apart = Config { apart_mm: 1.0, apart_deg: 0.5, ..triangle() };
    let (one, three) = one_and_three(&rig(&[]), apart);
    println!("with the room's field: {one:.2?} mm, degrees with one receiver, {three:.2?} with three");
    let quiet = rig(&[("position_noise_mm", 0.0), ("rotation_noise_deg", 0.0)]);
    let (field, _) = one_and_three(&quiet, Config { apart_mm: 5.0, apart_deg: 5.0, ..triangle() });
    println!("the field alone: {field:.2?} mm, degrees with one receiver");
    // The place is as wrong as the field makes it; the orientation gains, for much of its error was noise.
    assert!((three[0] / field[0] - 1.0).abs() < 0.2, "{three:?} {field:?}");
    assert!(three[1] < 0.6 * one[1], "{one:?} {three:?}");
}
