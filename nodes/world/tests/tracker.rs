//! The tracker's errors have the stated sizes, and every reading is a pure function of its index.
#![allow(clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

use geometry::{Rig, rigid_from_wire};
use nalgebra::{Isometry3, Vector3};
use proptest::prelude::*;
use world::{Hand, Scene, Simulation, Tracker};

const SECONDS: f64 = 10.0;

fn rig_with(tracker: &str) -> Rig {
    const HANDSET: &str = "[camera]\nwidth = 768\nheight = 576\nfx = 1200.0\nfy = 1200.0\ncx = 384.0\ncy = 288.0\n\
        [laser]\nnormal = [-0.894, 0.0, 0.447]\ndistance_m = 0.0894\nchannel_weights = [1.0, 0.0, 0.0]\n\
        peaks_per = \"row\"\n[body_from_camera]\ntranslation_m = [0.05, 0.0, 0.0]\nrotation_wxyz = [1.0, 0.0, 0.0, 0.0]\n";
    Rig::parse(&format!("{HANDSET}[simulation.tracker]\n{tracker}")).unwrap()
}

/// Nothing is wrong with it but what the test adds.
const PERFECT: &str = "position_noise_mm = 0\nrotation_noise_deg = 0\nfield_position_mm = 0\nfield_rotation_deg = 0\n\
    position_step_mm = 0\nrotation_step_deg = 0\nfilter_rest_s = 0\nfilter_moving_s = 0\nlatency_s = 0\n\
    clock_offset_s = 0\nstamp_jitter_s = 0\ndropped = 0\n";

/// `PERFECT` with some keys changed.
fn but(changes: &[(&str, f64)]) -> Rig {
    let mut table: toml::Table = PERFECT.parse().unwrap();
    for (key, value) in changes {
        table.insert((*key).to_owned(), toml::Value::Float(*value));
    }
    rig_with(&table.to_string())
}

fn hand(rig: &Rig) -> Hand {
    let scene = Scene::parse("[[object]]\nkind = \"sphere\"\nsides_mm = [90, 90, 90]\n", "".as_ref()).unwrap();
    Hand::new(&scene, rig, SECONDS, 5).unwrap()
}

/// Error vectors of all readings: position in the world, rotation about the body.
fn errors(rig: &Rig, seed: u64) -> Vec<[Vector3<f64>; 2]> {
    let hand = hand(rig);
    let tracker = Tracker::new(rig, hand.clone(), seed).unwrap();
    let error = |index: u64| {
        let truth = hand.world_from_body(tracker.time_s(index));
        let said = rigid_from_wire(&tracker.sample(index)?.world_from_body)?;
        let turn = (truth.rotation.inverse() * said.rotation).scaled_axis();
        Some([said.translation.vector - truth.translation.vector, turn])
    };
    (0..tracker.count()).filter_map(error).collect()
}

fn rms(vectors: impl Iterator<Item = Vector3<f64>> + Clone) -> f64 {
    let count = vectors.clone().count() as f64;
    (vectors.map(|v| v.norm_squared()).sum::<f64>() / count).sqrt()
}

fn assert_near(what: &str, found: f64, stated: f64, share: f64) {
    assert!((found - stated).abs() <= share * stated, "{what}: found {found}, stated {stated}");
}

#[test]
fn without_errors_it_tells_the_truth() {
    let all = errors(&but(&[]), 1);
    assert_eq!(all.len(), ((SECONDS + 0.6) * 100.0) as usize + 1);
    assert!(all.iter().flatten().all(|e| e.norm() < 1e-12));
}

#[test]
fn between_its_readings_it_shows_the_hand_and_at_them_what_they_say() {
    let rig = but(&[("position_noise_mm", 1.5), ("rotation_noise_deg", 3.0), ("field_position_mm", 5.0)]);
    let tracker = Tracker::new(&rig, hand(&rig), 1).unwrap();
    for index in [0, 1, 30, 517, tracker.count() - 1] {
        let said = rigid_from_wire(&tracker.sample(index).unwrap().world_from_body).unwrap();
        let shown = tracker.at(tracker.time_s(index));
        assert!((shown.translation.vector - said.translation.vector).norm() < 1e-12);
        assert!(shown.rotation.angle_to(&said.rotation) < 1e-9);
    }
    let perfect = but(&[]);
    let (hand, tracker) = (hand(&perfect), Tracker::new(&perfect, hand(&perfect), 1).unwrap());
    for t_s in [-1.0, 3.1234, 99.0] {
        let off = tracker.at(t_s).translation.vector - hand.world_from_body(t_s).translation.vector;
        assert!(off.norm() < 1e-12, "{t_s} s");
    }
}

#[test]
fn white_noise_has_the_stated_length_and_no_memory() {
    let all = errors(&but(&[("position_noise_mm", 1.5), ("rotation_noise_deg", 3.0)]), 1);
    assert_near("position", rms(all.iter().map(|e| e[0])), 1.5e-3, 0.05);
    assert_near("rotation", rms(all.iter().map(|e| e[1])).to_degrees(), 3.0, 0.05);
    let product: f64 = all.windows(2).map(|pair| pair[0][0].dot(&pair[1][0])).sum::<f64>() / all.len() as f64;
    assert!(product.abs() < 0.1 * 1.5e-3f64.powi(2), "{product}");
}

#[test]
fn coloured_noise_has_the_stated_size_and_memory() {
    let (mut square, mut product, mut count) = (0.0, 0.0, 0.0);
    for seed in 0..16 {
        let all = errors(&but(&[("drift_position_mm", 1.0), ("drift_time_s", 0.3)]), seed);
        square += all.iter().map(|e| e[0].norm_squared()).sum::<f64>();
        product += all.iter().zip(&all[30..]).map(|(a, b)| a[0].dot(&b[0])).sum::<f64>();
        count += all.len() as f64;
    }
    assert_near("size", (square / count).sqrt(), 1e-3, 0.06);
    assert_near("after one correlation time", product / square, (-1.0f64).exp(), 0.12);
}

#[test]
fn the_field_has_the_stated_size_and_is_smooth() {
    let one = [("field_position_mm", 8.0), ("field_wavelength_m", 0.5), ("field_growth", 0.0)];
    // One room is one field: its size is the mean over rooms.
    let rooms: Vec<_> = (0..24).map(|seed| errors(&but(&one), seed)).collect();
    assert_near("size", rms(rooms.iter().flatten().map(|e| e[0])), 8e-3, 0.2);
    let hand = hand(&but(&one));
    for room in &rooms {
        for (i, pair) in room.windows(2).enumerate() {
            let place = |i: usize| hand.world_from_body(i as f64 / 100.0 - 0.3).translation.vector;
            let way = (place(i + 1) - place(i)).norm();
            // The steepest that waves of this length and size could be, all in step: k times the peak.
            let steepest = std::f64::consts::TAU / 0.5 * 8e-3 * 8.0;
            assert!((pair[1][0] - pair[0][0]).norm() <= steepest * way + 1e-12);
        }
    }
}

#[test]
fn the_field_is_the_same_when_the_hand_comes_back_and_grows_from_the_base() {
    let near = [("field_position_mm", 8.0), ("field_growth", 1.0)];
    let (weak, strong) =
        (errors(&but(&near), 3), errors(&but(&[("field_position_mm", 16.0), ("field_growth", 1.0)]), 3));
    for (a, b) in weak.iter().zip(&strong) {
        assert!((a[0] * 2.0 - b[0]).norm() < 1e-12, "twice the size is the same field, twice");
    }
    let flat = errors(&but(&[("field_position_mm", 8.0), ("field_growth", 0.0)]), 3);
    let rig = but(&near);
    let hand = hand(&rig);
    let base = Vector3::from(Simulation::from_rig(&rig).unwrap().tracker.base_m);
    for (i, (grown, flat)) in weak.iter().zip(&flat).enumerate() {
        let distance = (hand.world_from_body(i as f64 / 100.0 - 0.3).translation.vector - base).norm();
        assert!((grown[0] - flat[0] * distance).norm() < 1e-9);
    }
}

#[test]
fn the_filter_lags_by_its_time_constant() {
    let rig = but(&[("filter_rest_s", 0.02), ("filter_moving_s", 0.02)]);
    let hand = hand(&rig);
    // Along the motion the error is the way of one time constant, once tremor is averaged out.
    let (mut lag, mut way) = (0.0, 0.0);
    for (i, error) in errors(&rig, 1).iter().enumerate() {
        let t = i as f64 / 100.0 - 0.3;
        let speed =
            (hand.world_from_body(t + 0.1).translation.vector - hand.world_from_body(t - 0.1).translation.vector) / 0.2;
        lag -= error[0].dot(&speed);
        way += speed.norm_squared();
    }
    assert_near("lag in seconds", lag / way, 0.02, 0.05);
}

#[test]
fn a_resting_handset_is_filtered_harder_than_a_moving_one() {
    let still = errors(&but(&[("filter_rest_s", 0.1), ("filter_moving_s", 0.001), ("filter_speed_mm_per_s", 1.0)]), 1);
    let slow =
        errors(&but(&[("filter_rest_s", 0.1), ("filter_moving_s", 0.001), ("filter_speed_mm_per_s", 5000.0)]), 1);
    assert!(rms(slow.iter().map(|e| e[0])) > 5.0 * rms(still.iter().map(|e| e[0])));
}

#[test]
fn stamps_are_late_by_latency_and_offset_and_never_swap() {
    let rig = but(&[("latency_s", 0.0075), ("clock_offset_s", -0.0025), ("stamp_jitter_s", 0.01)]);
    let tracker = Tracker::new(&rig, hand(&rig), 1).unwrap();
    let stamps: Vec<i64> =
        (0..tracker.count()).filter_map(|i| tracker.sample(i)).map(|p| p.header.stamp_nanos).collect();
    assert!(stamps.windows(2).all(|pair| pair[0] < pair[1]));
    let late = stamps.iter().enumerate().map(|(i, s)| *s as f64 * 1e-9 - tracker.time_s(i as u64)).sum::<f64>();
    assert_near("mean", late / stamps.len() as f64, 0.005, 0.05);
}

#[test]
fn lost_readings_have_the_stated_share_and_come_in_rows() {
    let rig = but(&[("dropped", 0.05), ("dropped_in_a_row", 4.0)]);
    let (mut lost, mut gaps, mut all) = (0.0, 0.0, 0.0);
    for seed in 0..30 {
        let tracker = Tracker::new(&rig, hand(&rig), seed).unwrap();
        let there: Vec<bool> = (0..tracker.count()).map(|i| tracker.sample(i).is_some()).collect();
        lost += there.iter().filter(|there| !**there).count() as f64;
        gaps += there.windows(2).filter(|pair| pair[0] && !pair[1]).count() as f64;
        all += there.len() as f64;
    }
    assert_near("share", lost / all, 0.05, 0.15);
    assert_near("in a row", lost / gaps, 4.0, 0.2);
}

#[test]
fn readings_are_rounded_to_steps() {
    let rig = but(&[("position_step_mm", 0.5), ("rotation_step_deg", 1.0)]);
    let tracker = Tracker::new(&rig, hand(&rig), 1).unwrap();
    for i in (0..tracker.count()).step_by(50) {
        let pose: Isometry3<f64> = rigid_from_wire(&tracker.sample(i).unwrap().world_from_body).unwrap();
        let steps = pose.translation.vector / 0.5e-3;
        assert!((steps - steps.map(f64::round)).norm() < 1e-9);
        let (roll, pitch, yaw) = pose.rotation.euler_angles();
        assert!([roll, pitch, yaw].iter().all(|a| (a.to_degrees() - a.to_degrees().round()).abs() < 1e-6));
    }
}

#[test]
fn shipped_rigs_are_sound_and_know_their_clocks() {
    for name in ["paper", "fine"] {
        let path = format!("{}/../../config/rigs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let rig = Rig::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
        let section = Simulation::from_rig(&rig).unwrap().tracker;
        let offset = section.latency_s + section.clock_offset_s;
        assert!((rig.clock.pose_offset_s + offset).abs() < 1e-9, "{name}: stamps are late by {offset} s");
        let sheet = rig.sheet().unwrap();
        let on_axis = sheet.intersect(&Vector3::z()).unwrap();
        assert!((on_axis.z - 0.2).abs() < 1e-4, "{name}: the sheet crosses the axis at {}", on_axis.z);
        let angle = sheet.normal.z.abs().asin().to_degrees();
        assert!((25.0..30.0).contains(&angle), "{name}: {angle} degrees");
    }
}

#[test]
fn impossible_numbers_are_named() {
    for (line, word) in [("rate_hz = 0", "rate_hz"), ("dropped = nan", "dropped"), ("rate = 9", "rate_hz")] {
        let said = Simulation::from_rig(&rig_with(line)).unwrap_err().to_string();
        assert!(said.contains(word), "{line}: {said}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn any_reading_can_be_had_in_any_order(index in 0u64..1000, seed in any::<u64>()) {
        let rig = rig_with("");
        let [one, other] = [(); 2].map(|()| Tracker::new(&rig, hand(&rig), seed).unwrap());
        for i in (0..20).rev() {
            other.sample(i);
        }
        prop_assert_eq!(one.sample(index), other.sample(index));
        if let Some(pose) = one.sample(index) {
            prop_assert!(rigid_from_wire(&pose.world_from_body).is_some());
        }
    }
}
