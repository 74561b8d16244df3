//! Noise as stated, and the same bytes for the same question.

use crate::bench::*;
use nalgebra::Isometry3;
use world::optics::{CameraModelSim, Workspace};

#[test]
fn shot_and_read_noise_are_as_stated() {
    let optics = "
        vignetting = 0
        sensor = { full_well_electrons = 4000, read_noise_electrons = 20, sensitivity = [0.9, 1.0, 0.4], gamma = 1 }
        gain = { automatic = false, lowest = 1.5, highest = 2 }";
    let (scene, rig) = (scene(vec![square_on(0.2)], 0.5), rig(optics));
    let camera = CameraModelSim::new(&scene, &rig, 11).unwrap();
    let mut memory = Workspace::default();
    let frames: Vec<_> = (0..6).map(|i| camera.render(i, &Isometry3::identity(), ROOM, &mut memory)).collect();
    for (channel, share) in [0.9, 1.0, 0.4].into_iter().enumerate() {
        let values: Vec<f64> = frames
            .iter()
            .flat_map(|frame| {
                (40..200).flat_map(move |row| (40..280).map(move |column| value(frame, column, row, channel)))
            })
            .collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
        let full = 4000.0 * share;
        let electrons = mean / 255.0 / 1.5 * full;
        let expected = (electrons + 400.0) * (1.5 / full * 255.0_f64).powi(2) + 1.0 / 12.0;
        assert!((variance / expected - 1.0).abs() < 0.03, "channel {channel}: {variance} for {expected}");
        // From pixel to pixel and from frame to frame nothing is alike.
        let width = 240;
        let across: f64 = (1..values.len()).map(|i| (values[i] - mean) * (values[i - 1] - mean)).sum::<f64>() / count;
        let frame = 160 * width;
        let later = (frame..values.len()).map(|i| (values[i] - mean) * (values[i - frame] - mean)).sum::<f64>() / count;
        assert!(across.abs() < 0.02 * variance && later.abs() < 0.02 * variance, "{across} {later} of {variance}");
    }
}

#[test]
fn the_same_question_gets_the_same_bytes_whatever_was_asked_before() {
    let (scene, rig) = (scene(vec![square_on(0.2)], 0.1), rig(""));
    let camera = CameraModelSim::new(&scene, &rig, 11).unwrap();
    let here = Isometry3::identity();
    let elsewhere = Isometry3::translation(0.01, -0.02, 0.03);
    let fresh = camera.render(4, &here, LASER, &mut Workspace::default());
    let mut used = Workspace::default();
    for (index, light) in [(3, LASER), (9, LAMP), (2, LASER)] {
        camera.render(index, &elsewhere, light, &mut used);
    }
    assert_eq!(camera.render(4, &here, LASER, &mut used), fresh);
    assert_ne!(camera.render(5, &here, LASER, &mut used).data, fresh.data, "each frame has its own noise");
    let other = CameraModelSim::new(&scene, &rig, 12).unwrap();
    assert_ne!(other.render(4, &here, LASER, &mut used).data, fresh.data, "each seed has its own noise");
}
