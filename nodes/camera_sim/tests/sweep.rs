//! The frames of a sweep: when, lit by what, and the same on any number of threads.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use camera_sim::CameraSim;
use geometry::Rig;
use wire::{Clock, Phase};
use world::{Hand, Known, Scene};

fn known(two_passes: bool) -> Known {
    let text = r#"
        camera = { width = 192, height = 144, fx = 300.0, fy = 300.0, cx = 97.1, cy = 70.8 }
        laser = { normal = [-0.894, 0.0, 0.447], distance_m = 0.0894, channel_weights = [1, 0, 0], peaks_per = "row" }
        body_from_camera = { translation_m = [0.05, -0.03, 0.0], rotation_wxyz = [0.5, 0.5, -0.5, 0.5] }
        [simulation.optics]
        rate_hz = 50
        lamp_every = 4"#;
    let mut scene = Scene::cow().unwrap();
    scene.hand.two_passes = two_passes;
    let rig = Rig::parse(text).unwrap();
    let hand = Hand::new(&scene, &rig, 2.0, 5).unwrap();
    Known { scene, rig, hand, seed: 5 }
}

#[test]
fn a_batch_is_the_same_bytes_on_one_thread_and_on_three() {
    let camera = CameraSim::new(&known(false)).unwrap();
    let on = |threads: usize| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| camera.batch(60..72))
    };
    let alone = on(1);
    assert_eq!(alone, on(3));
    assert_eq!(alone[4], camera.frame(64));
}

#[test]
fn stamps_stand_in_the_middle_of_each_exposure_and_lights_take_turns() {
    let camera = CameraSim::new(&known(false)).unwrap();
    assert_eq!(camera.frames(), 100);
    let frames = camera.batch(0..camera.frames());
    for (index, frame) in frames.iter().enumerate() {
        frame.check().unwrap();
        assert_eq!(frame.header.stamp_nanos, 10_000_000 + 20_000_000 * index as i64);
        assert_eq!((frame.header.seq, &frame.header.clock), (index as u64, &Clock::Scan));
        assert_ne!(frame.light.laser, frame.light.lamp);
        let lamp = frame.header.phase == Phase::Both && index % 4 == 0;
        assert_eq!(frame.light.lamp, lamp, "frame {index} of {:?}", frame.header.phase);
    }
    assert_eq!(frames[0].header.phase, Phase::Aim);
    assert_eq!(frames[99].header.phase, Phase::Both);
    assert!(camera.blank().data.is_empty());
}

#[test]
fn two_passes_have_the_laser_first_and_then_the_lamp() {
    let camera = CameraSim::new(&known(true)).unwrap();
    assert_eq!(camera.light(40).0, Phase::Shape);
    assert!(camera.light(40).1.laser);
    assert_eq!(camera.light(80).0, Phase::Colour);
    assert!(camera.light(80).1.lamp);
}

#[test]
fn the_truth_is_told_for_each_frame() {
    let camera = CameraSim::new(&known(false)).unwrap();
    let truth = camera.truth();
    assert_eq!(truth.samples.len(), 100);
    assert_eq!(truth.header.stamp_nanos, camera.stamp_nanos(99));
    let seen = (0..100).filter(|index| camera.truth_stripe(*index).len() > 20).count();
    assert!(seen > 30, "the line is on the cow or the table in {seen} frames");
}
