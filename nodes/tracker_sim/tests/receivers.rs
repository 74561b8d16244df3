//! Several receivers on one handset: each where it sits, in the same room, with noise of its own.
#![allow(clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

use geometry::{Rig, TransformSection, rigid_from_wire};
use nalgebra::{Isometry3, Vector3};
use tracker_sim::{Config, TrackerSim, TrackerSimError};
use wire::{Pose, codec};
use world::Scene;

const SECONDS: f64 = 4.0;
const PLACE: TransformSection =
    TransformSection { translation_m: [0.1, -0.02, 0.03], rotation_wxyz: [0.8, 0.0, 0.6, 0.0] };
const NOWHERE: TransformSection = TransformSection { translation_m: [0.0; 3], rotation_wxyz: [1.0, 0.0, 0.0, 0.0] };

/// The paper's handset; of its tracker's errors those that a list names are as it says, all others nothing.
fn rig(errors: &[(&str, f64)]) -> Rig {
    let path = format!("{}/../../config/rigs/paper.toml", env!("CARGO_MANIFEST_DIR"));
    let mut rig = Rig::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    let tracker = rig.simulation.as_mut().unwrap()["tracker"].as_table_mut().unwrap();
    let none = ["position_noise_mm", "rotation_noise_deg", "field_position_mm", "field_rotation_deg", "stamp_jitter_s"];
    let none = none.into_iter().chain([
        "position_step_mm",
        "rotation_step_deg",
        "filter_rest_s",
        "filter_moving_s",
        "dropped",
    ]);
    for (key, value) in none.map(|key| (key, 0.0)).chain(errors.iter().copied()) {
        tracker.insert(key.to_owned(), value.into());
    }
    rig
}

fn scene() -> Scene {
    Scene::parse("[[object]]\nkind = \"sphere\"\nsides_mm = [90, 90, 90]\n", "".as_ref()).unwrap()
}

fn receiver(rig: &Rig, place: &TransformSection, name: &str) -> Vec<Pose> {
    TrackerSim::receiver(&scene(), rig, SECONDS, 3, place, name).unwrap().collect()
}

fn said(pose: &Pose) -> Isometry3<f64> {
    rigid_from_wire(&pose.world_from_body).unwrap()
}

/// Errors against a tracker that errs in nothing, in the world: metres.
fn errors(errors: &[(&str, f64)], place: &TransformSection, name: &str) -> Vec<Vector3<f64>> {
    let (found, truth) = (receiver(&rig(errors), place, name), receiver(&rig(&[]), place, name));
    assert_eq!(found.len(), truth.len());
    let error = |(a, b): (&Pose, &Pose)| said(a).translation.vector - said(b).translation.vector;
    found.iter().zip(&truth).map(error).collect()
}

/// Correlation coefficient of two rows of errors.
fn correlation(a: &[Vector3<f64>], b: &[Vector3<f64>]) -> f64 {
    let dot = |a: &[Vector3<f64>], b: &[Vector3<f64>]| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
    dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
}

#[test]
fn a_receiver_is_where_it_sits_on_the_handset() {
    let rig = rig(&[]);
    let body: Vec<Pose> = TrackerSim::new(&scene(), &rig, SECONDS, 3).unwrap().collect();
    let there = receiver(&rig, &PLACE, "there");
    let mount =
        rigid_from_wire(&wire::RigidPose { translation_m: PLACE.translation_m, rotation_wxyz: PLACE.rotation_wxyz });
    assert_eq!(body.len(), there.len());
    for (body, there) in body.iter().zip(&there) {
        let off = (said(body) * mount.unwrap()).inverse() * said(there);
        assert!(off.translation.vector.norm() < 1e-9 && off.rotation.angle() < 1e-9, "{off}");
        assert_eq!(body.header, there.header);
    }
}

#[test]
fn noise_is_each_receivers_own_and_the_same_for_the_same_name() {
    let noisy = [("position_noise_mm", 1.5), ("rotation_noise_deg", 3.0), ("dropped", 0.05)];
    let bytes = |name: &str| receiver(&rig(&noisy), &PLACE, name).iter().map(codec::encode).collect::<Vec<_>>();
    assert_eq!(bytes("left"), bytes("left"));
    assert_ne!(bytes("left"), bytes("right"));
    let noise = [("position_noise_mm", 1.5)];
    let [left, right] = ["left", "right"].map(|name| errors(&noise, &PLACE, name));
    assert!(correlation(&left, &right).abs() < 0.15, "{}", correlation(&left, &right));
}

#[test]
fn the_room_bends_all_receivers_alike() {
    let field = [("field_position_mm", 10.9)];
    let [here, same, there] =
        [(NOWHERE, "here"), (NOWHERE, "same"), (PLACE, "there")].map(|(place, name)| errors(&field, &place, name));
    let alike = correlation(&here, &same);
    assert!((alike - 1.0).abs() < 1e-9, "at one place the room is one: {alike}");
    let near = correlation(&here, &there);
    assert!((0.8..0.9999).contains(&near), "10 cm away it is nearly the same: {near}");
}

#[test]
fn the_configuration_is_the_cameras_and_a_place() {
    let config: Config =
        toml::from_str("seconds = 7.0\nreceiver = { translation_m = [0.1, 0, 0], rotation_wxyz = [1, 0, 0, 0] }")
            .unwrap();
    assert_eq!((config.setup.seconds, config.setup.seed), (7.0, 1));
    assert_eq!(config.receiver.unwrap().translation_m, [0.1, 0.0, 0.0]);
    assert!(toml::from_str::<Config>("secondss = 7.0").is_err() && toml::from_str::<Config>("seconds = 7.0").is_ok());
    assert_eq!(toml::from_str::<Config>("").unwrap(), Config::default());

    let bad = TransformSection { rotation_wxyz: [0.0; 4], ..PLACE };
    assert!(Config { receiver: Some(bad), ..Config::default() }.check().unwrap_err().to_string().contains("receiver"));
    let refused = TrackerSim::receiver(&scene(), &rig(&[]), SECONDS, 3, &bad, "left");
    assert!(matches!(refused, Err(TrackerSimError::Receiver(_))));
}
