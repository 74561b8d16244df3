//! The smooth way against a hand that is known exactly, and everything that can be wrong with readings.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod hand;

use geometry::{SmoothCounts, SmoothError, SmoothTrajectory, Smoothing, TimedPose};
use hand::{Hand, MS, Tracker, rms};

fn fit(readings: &[TimedPose]) -> SmoothTrajectory {
    SmoothTrajectory::fit(readings, &Smoothing::default()).unwrap()
}

/// Frames lie between the readings, where nothing was measured.
fn smooth_rms(hand: &Hand, way: &SmoothTrajectory, seconds: i64) -> (f64, f64) {
    let stamps = (0..seconds * 60 - 2).map(|i| i * 16_666_667 + 3 * MS);
    rms(hand, stamps.map(|stamp| (stamp, way.at(stamp).unwrap())))
}

fn raw_rms(hand: &Hand, readings: &[TimedPose]) -> (f64, f64) {
    rms(hand, readings.iter().map(|r| (r.stamp_nanos, r.pose)))
}

#[test]
fn the_papers_tracker_is_steadied_and_its_noise_found() {
    for seed in 1..=3 {
        let readings = Tracker::PAPER.readings(&Hand::USUAL, 60, seed);
        let way = fit(&readings);
        let (raw, smooth) = (raw_rms(&Hand::USUAL, &readings), smooth_rms(&Hand::USUAL, &way, 60));
        println!("paper, seed {seed}: raw {raw:.3?} smooth {smooth:.3?} mm, degrees");
        println!("  lambda {:.3e} {:.3e}", way.lambda_position(), way.lambda_rotation());
        assert!(smooth.0 < 0.6 && smooth.1 < 0.9, "{smooth:?}");
        let white = (1.5e-3 / 3f64.sqrt(), 3f64.to_radians() / 3f64.sqrt());
        for axis in 0..3 {
            let (position, rotation) =
                (way.position_sigma_m()[axis] / white.0, way.rotation_sigma_rad()[axis] / white.1);
            println!("  axis {axis}: sigma found over sigma true {position:.3} {rotation:.3}");
            assert!((0.96..1.04).contains(&position) && (0.96..1.04).contains(&rotation));
        }
        assert_eq!(way.counts(), SmoothCounts { readings: 6000, ..SmoothCounts::default() });
    }
}

#[test]
fn a_fine_tracker_is_not_spoiled_by_smoothing_the_tremor_away() {
    let readings = Tracker::FINE.readings(&Hand::USUAL, 60, 5);
    let way = fit(&readings);
    let (raw, smooth) = (raw_rms(&Hand::USUAL, &readings), smooth_rms(&Hand::USUAL, &way, 60));
    println!("fine: raw {raw:.4?} smooth {smooth:.4?} mm, degrees");
    println!("  lambda {:.3e} {:.3e}", way.lambda_position(), way.lambda_rotation());
    println!(
        "  sigma {:.5} mm {:.5} deg",
        way.position_sigma_m().norm() * 1e3,
        way.rotation_sigma_rad().norm().to_degrees()
    );
    assert!(smooth.0 < 0.9 * raw.0 && smooth.1 < 0.9 * raw.1);
}

#[test]
fn stated_sigma_of_the_smooth_pose_covers_its_error() {
    let readings = Tracker::PAPER.readings(&Hand { tremor_m: 0.0, tremor_deg: 0.0 }, 60, 9);
    let way = fit(&readings);
    let (mut position, mut rotation, mut count) = (0.0, 0.0, 0.0);
    for stamp in (0..59_900).step_by(7).map(|ms| ms * MS) {
        let (truth, found) = (Hand { tremor_m: 0.0, tremor_deg: 0.0 }.at(stamp), way.at(stamp).unwrap());
        let sigma = way.sigma(stamp).unwrap();
        position += (found.translation.vector - truth.translation.vector).norm_squared() / (3.0 * sigma.0 * sigma.0);
        rotation += found.rotation.angle_to(&truth.rotation).powi(2) / (3.0 * sigma.1 * sigma.1);
        count += 1.0;
    }
    let pull = ((position / count as f64).sqrt(), (rotation / count as f64).sqrt());
    println!("pull {pull:.3?}");
    assert!((0.8..1.2).contains(&pull.0) && (0.8..1.2).contains(&pull.1));
}
