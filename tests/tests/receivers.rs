//! Three receivers on one handset, as a user starts them: launch/three_receivers.toml, with real processes.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use bus::Bus;
use geometry::{TimedPose, TrajectoryBuffer, rigid_from_wire};
use nalgebra::Isometry3;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use system_tests::rig::{Course, Rig, first, signal, wait_on, wait_until};
use system_tests::{limn, repository, same_bytes, short_sets};
use tempfile::TempDir;
use wire::{Calibration, Pose, Quality, RigidPose, topic};

const MODEL: [&str; 4] = ["cloud.ply", "mesh.ply", "model.glb", "model.png"];

/// The tests' handset with the noise of the paper's tracker, in a room that bends nothing.
fn noisy_rig(out: &Path) -> PathBuf {
    let path = system_tests::quick_rig(out);
    let mut rig: toml::Table = std::fs::read_to_string(&path).unwrap().parse().unwrap();
    let tracker = rig["simulation"]["tracker"].as_table_mut().unwrap();
    for (key, value) in [("position_noise_mm", 1.5), ("rotation_noise_deg", 3.0), ("field_position_mm", 0.0)] {
        tracker.insert(key.to_owned(), value.into());
    }
    let path = out.join("noisy.toml");
    std::fs::write(&path, toml::to_string(&rig).unwrap()).unwrap();
    path
}

fn three_receivers(out: &Path) -> Command {
    let mut up = limn();
    up.arg("up").arg(repository("launch/three_receivers.toml"));
    short_sets(&mut up, out);
    let rig = noisy_rig(out);
    for source in ["camera", "tracker", "tracker_left", "tracker_right"] {
        up.args(["--set", &format!("{source}.rig={rig:?}"), "--set", &format!("{source}.seconds=6.0")]);
    }
    up.args(["--set", &format!("rig.file={rig:?}")]);
    up
}

/// All readings of a tracker, up to the message behind the last.
fn readings(bus: &Bus, tracker: &str) -> Vec<Pose> {
    let mut stream = bus.subscribe(&topic::pose(tracker), 1 << 16).unwrap();
    let mut poses: Vec<Pose> = Vec::new();
    wait_on(bus, &format!("the readings of {tracker} do not end"), || {
        poses.extend(std::iter::from_fn(|| stream.next()));
        poses.pop_if(|pose| pose.header.is_end())
    });
    poses
}

/// Errors of the camera's pose against the truth, in millimetres and degrees, root mean square.
fn errors(poses: &[Pose], body_from_camera: &Isometry3<f64>, offset_nanos: i64, truth: &[TimedPose]) -> [f64; 2] {
    let mut way = TrajectoryBuffer::default();
    for pose in poses.iter().filter(|pose| pose.quality != Quality::Lost) {
        way.push(TimedPose {
            stamp_nanos: pose.header.stamp_nanos + offset_nanos,
            pose: rigid_from_wire(&pose.world_from_body).unwrap() * body_from_camera,
            position_sigma_m: 0.0,
            rotation_sigma_rad: 0.0,
        });
    }
    let (mut sums, mut count) = ([0.0; 2], 0.0);
    for truth in truth {
        let Ok(found) = way.at(truth.stamp_nanos, 100_000_000) else { continue };
        sums[0] += (found.pose.translation.vector - truth.pose.translation.vector).norm_squared() * 1e6;
        sums[1] += found.pose.rotation.angle_to(&truth.pose.rotation).to_degrees().powi(2);
        count += 1.0;
    }
    assert!(count > 100.0, "only {count} pictures have a pose");
    sums.map(|sum: f64| (sum / count).sqrt())
}

/// A scan in which nothing goes wrong.
struct Undisturbed {
    out: TempDir,
    calibration: Calibration,
    /// By three receivers, and by the first of them.
    fused: Vec<Pose>,
    top: Vec<Pose>,
    truth: Vec<TimedPose>,
}

fn undisturbed() -> &'static Undisturbed {
    static RUN: OnceLock<Undisturbed> = OnceLock::new();
    RUN.get_or_init(|| {
        let out = tempfile::tempdir().unwrap();
        let mut rig = Rig::start(three_receivers(out.path()).args(["--set", "run.once=false"]));
        let bus = rig.bus();
        Course::follow(&bus).wait_for_end("export/model");
        let [fused, top] = ["head", "top"].map(|tracker| readings(&bus, tracker));
        let truth = first(&bus, &topic::truth_trajectory("head")).samples.iter().map(TimedPose::from).collect();
        let calibration = first(&bus, &topic::calibration("head"));
        drop(bus);
        signal(rig.pid(), "INT");
        let (status, said) = rig.end();
        assert!(status.success() && !said.contains("messages lost"), "{said}");
        Undisturbed { out, calibration, fused, top, truth }
    })
}

#[test]
fn three_receivers_give_a_model_by_one_pose_that_is_better_than_each() {
    let Undisturbed { out, calibration, fused, top, truth } = undisturbed();
    for file in MODEL.into_iter().chain(["scan.mcap"]) {
        assert!(out.path().join(file).metadata().is_ok_and(|file| file.len() > 0), "{file} is missing or empty");
    }
    assert!(fused.len() as f64 > 0.99 * top.len() as f64, "{} of {}", fused.len(), top.len());
    let good = fused.iter().filter(|pose| pose.quality == Quality::Good).count();
    assert!(good as f64 > 0.95 * fused.len() as f64, "{good} of {}", fused.len());

    let body_from_camera = rigid_from_wire(&calibration.body_from_camera).unwrap();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let body_from_top = RigidPose { translation_m: [0.0, 0.1, 0.0], rotation_wxyz: [half, 0.0, 0.0, half] };
    let top_from_camera = rigid_from_wire(&body_from_top).unwrap().inverse() * body_from_camera;
    let offset = calibration.pose_offset_nanos;
    let one = errors(top, &top_from_camera, offset, truth);
    let three = errors(fused, &body_from_camera, offset, truth);
    println!("the camera by one receiver: {one:.2?} mm, degrees; by three: {three:.2?}");
    assert!(three[1] < 0.35 * one[1] && three[0] < 0.5 * one[0], "{one:?} {three:?}");
}

#[test]
fn a_fuse_that_dies_in_mid_scan_is_started_again_and_the_model_is_the_same() {
    let out = tempfile::tempdir().unwrap();
    let mut rig = Rig::start(&mut three_receivers(out.path()));
    let bus = rig.bus();
    Course::follow(&bus).wait_for("fuse/head", 3_000_000_000);
    let killed = rig.node("fuse").unwrap();
    signal(killed, "KILL");
    wait_until("it is not started again", || rig.node("fuse").is_some_and(|again| again != killed));
    drop(bus);
    let (status, said) = rig.end();
    assert!(status.success() && said.contains("signal: 9") && !said.contains("messages lost"), "{said}");
    MODEL.iter().for_each(|file| same_bytes(undisturbed().out.path(), out.path(), file));
}

#[test]
fn a_receiver_that_never_speaks_holds_the_others_up_once() {
    let out = tempfile::tempdir().unwrap();
    let mut up = three_receivers(out.path());
    let (status, said) = Rig::start(up.args(["--set", "nodes.tracker_right.enabled=false"])).end();
    assert!(status.success() && !said.contains("messages lost"), "{said}");
    assert_eq!(said.matches("right is silent or late").count(), 1, "{said}");
    assert!(said.contains("poses, 0 of them by all receivers, 0 moments without"), "{said}");
    assert!(out.path().join("mesh.ply").is_file(), "{said}");
}
