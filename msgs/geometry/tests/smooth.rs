//! The smooth way against a hand that is known exactly, and everything that can be wrong with readings.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod hand;

use geometry::{SmoothCounts, SmoothError, SmoothTrajectory, Smoothing, TimedPose};
use hand::{Hand, MS, Noise, Tracker, rms};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;

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
    let (mut position, mut rotation, mut count) = (0.0, 0.0, 0.0f64);
    for stamp in (0..59_900).step_by(7).map(|ms| ms * MS) {
        let (truth, found) = (Hand { tremor_m: 0.0, tremor_deg: 0.0 }.at(stamp), way.at(stamp).unwrap());
        let sigma = way.sigma(stamp).unwrap();
        position += (found.translation.vector - truth.translation.vector).norm_squared() / (3.0 * sigma.0 * sigma.0);
        rotation += found.rotation.angle_to(&truth.rotation).powi(2) / (3.0 * sigma.1 * sigma.1);
        count += 1.0;
    }
    let pull = ((position / count).sqrt(), (rotation / count).sqrt());
    println!("pull {pull:.3?}");
    assert!((0.8..1.2).contains(&pull.0) && (0.8..1.2).contains(&pull.1));
}

#[test]
fn time_grows_with_the_readings() {
    let readings = Tracker::PAPER.readings(&Hand::USUAL, 600, 2);
    let started = std::time::Instant::now();
    let way = fit(&readings);
    println!("600 s at 100 Hz: {:.0} ms", started.elapsed().as_secs_f64() * 1e3);
    assert_eq!(way.span_nanos(), (0, 599_990 * MS));
    assert!(smooth_rms(&Hand::USUAL, &way, 600).0 < 0.6);
}

/// Exactly what the penalty lets through: a parabola in position, no turning.
#[test]
fn a_parabola_stays_one() {
    let truth = |stamp: i64| {
        let t = stamp as f64 * 1e-9;
        Vector3::new(0.3 + 0.1 * t, 0.02 * t * t, -0.4)
    };
    let reading = |i: i64| TimedPose {
        stamp_nanos: 1_700_000_000_000_000_000 + i * 7 * MS,
        pose: Isometry3::from_parts(
            Translation3::from(truth(i * 7 * MS)),
            UnitQuaternion::from_euler_angles(1.0, 0.2, 3.0),
        ),
        position_sigma_m: 0.0,
        rotation_sigma_rad: f64::NAN,
    };
    let readings: Vec<TimedPose> = (0..400).map(reading).collect();
    let way = fit(&readings);
    for ms in [0, 3, 1500, 2793] {
        let pose = way.at(1_700_000_000_000_000_000 + ms * MS).unwrap();
        assert!((pose.translation.vector - truth(ms * MS)).norm() < 1e-9, "{ms}");
        assert!(pose.rotation.angle_to(&readings[0].pose.rotation) < 1e-7);
    }
    assert_eq!(way.counts(), SmoothCounts { readings: 400, ..SmoothCounts::default() });
}

#[test]
fn velocity_is_the_derivative_in_the_moving_frame() {
    let way = fit(&Tracker::FINE.readings(&Hand::USUAL, 5, 2));
    for stamp in [MS, 777 * MS, 2_345_678_901] {
        let (step, twist) = (MS / 100, way.velocity(stamp).unwrap());
        let (before, behind) = (way.at(stamp - step).unwrap(), way.at(stamp + step).unwrap());
        let pose = way.at(stamp).unwrap();
        let seconds = 2e-9 * step as f64;
        let linear = pose.rotation.inverse() * (behind.translation.vector - before.translation.vector) / seconds;
        let angular = (before.rotation.inverse() * behind.rotation).scaled_axis() / seconds;
        assert!((linear - twist.fixed_rows::<3>(0)).norm() < 1e-5 * linear.norm());
        assert!((angular - twist.fixed_rows::<3>(3)).norm() < 1e-5 * angular.norm());
    }
}

#[test]
fn a_quaternion_may_have_either_sign() {
    let readings = Tracker::PAPER.readings(&Hand::USUAL, 20, 6);
    let mut noise = Noise(1);
    let mut flipped = readings.clone();
    for reading in flipped.iter_mut().filter(|_| noise.uniform() < 0.5) {
        reading.pose.rotation = UnitQuaternion::new_unchecked(-reading.pose.rotation.into_inner());
    }
    let (one, other) = (fit(&readings), fit(&flipped));
    for stamp in (0..19_990).step_by(13).map(|ms| ms * MS) {
        assert!(one.at(stamp).unwrap().rotation.angle_to(&other.at(stamp).unwrap().rotation) < 1e-9);
    }
}

#[test]
fn silence_is_told_and_not_invented() {
    let mut readings = Tracker::PAPER.readings(&Hand::USUAL, 40, 7);
    let silent = [(5000, 5300), (12_000, 15_000), (20_000, 20_050)];
    readings.retain(|r| !silent.iter().any(|(from, until)| (from * MS..until * MS).contains(&r.stamp_nanos)));
    let way = fit(&readings);
    let gaps: Vec<(i64, i64)> = way.gaps().iter().map(|gap| (gap.from_nanos / MS, gap.until_nanos / MS)).collect();
    assert_eq!(gaps, [(4990, 5300), (11_990, 15_000)]);
    for ms in [5000, 5299, 11_991, 14_000] {
        assert!(way.at(ms * MS).is_none() && way.velocity(ms * MS).is_none() && way.sigma(ms * MS).is_none());
    }
    let poses = |range: std::ops::RangeInclusive<i64>| range.map(|ms| (ms * MS, way.at(ms * MS).unwrap()));
    for (name, at) in [("before", 4900..=4990), ("behind", 15_000..=15_100), ("short", 19_990..=20_050)] {
        let found = rms(&Hand::USUAL, poses(at));
        println!("{name}: {found:.3?}");
        assert!(found.0 < 1.5 && found.1 < 3.0, "{name}: {found:?}");
    }
    // A few readings on their own, long after all others, hold nothing.
    let mut noise = Noise(1);
    readings.extend((0..4).map(|i| Tracker::PAPER.read(&Hand::USUAL, (60_000 + 10 * i) * MS, &mut noise)));
    let way = fit(&readings);
    assert_eq!((way.counts().stranded, way.span_nanos().1), (4, 39_990 * MS));
    // Nor do more that are all at odds with one another; they spoil nothing before them.
    for (i, wild) in (0..9).zip([0.0, 3.0, -2.0, 5.0, 0.0, 9.0, -7.0, 1.0, 30.0]) {
        let mut reading = Tracker::PAPER.read(&Hand::USUAL, (80_000 + 10 * i) * MS, &mut noise);
        reading.pose.translation.x += wild;
        readings.push(reading);
    }
    let way = fit(&readings);
    let at = (20_100..39_900).step_by(7).filter_map(|ms| Some((ms * MS, way.at(ms * MS)?)));
    let found = rms(&Hand::USUAL, at);
    println!("before wild readings: {found:.3?} {:?}", way.counts());
    assert!(found.0 < 0.6 && found.1 < 0.9);
    let sigma = way.position_sigma_m().norm() / 1.5e-3;
    assert!((0.95..1.05).contains(&sigma), "{sigma}");
}

#[test]
fn outliers_are_left_out_and_counted() {
    for (tracker, seed) in [(Tracker::PAPER, 1), (Tracker::FINE, 2)] {
        let good = tracker.readings(&Hand::USUAL, 30, seed);
        let mut bad = good.clone();
        let outliers = [3, 500, 501, 1000, 1200, 1203, 2000, 2001, 2002, 2990];
        for (i, &at) in outliers.iter().enumerate() {
            let pose = &mut bad[at].pose;
            pose.translation.vector += Vector3::new(0.05, -0.5, 3.0) * (i + 1) as f64;
            pose.rotation = UnitQuaternion::from_euler_angles(2.0, 0.1 * i as f64, 1.0) * pose.rotation;
        }
        let (clean, way) = (fit(&good), fit(&bad));
        assert_eq!(way.counts().position_outliers, outliers.len());
        assert_eq!(way.counts().rotation_outliers, outliers.len());
        assert_eq!((clean.counts().position_outliers, clean.counts().rotation_outliers), (0, 0));
        let (clean, found) = (smooth_rms(&Hand::USUAL, &clean, 29), smooth_rms(&Hand::USUAL, &way, 29));
        println!("without outliers {clean:.4?}, with {found:.4?}");
        assert!(found.0 < 1.1 * clean.0 && found.1 < 1.1 * clean.1);
    }
}

#[test]
fn readings_count_by_what_the_tracker_says_of_them() {
    let (mut noise, bad) = (Noise(5), Tracker { noise_m: 7.5e-3, noise_deg: 15.0 });
    let kind = |i: i64| if i % 3 == 1 { bad } else { Tracker::PAPER };
    let all: Vec<TimedPose> = (0..3000).map(|i| kind(i).read(&Hand::USUAL, i * 10 * MS, &mut noise)).collect();
    let usual = |r: &&TimedPose| r.position_sigma_m < 1e-3;
    let good: Vec<TimedPose> = all.iter().filter(usual).copied().collect();
    let (with, without) = (fit(&all), fit(&good));
    let sigma = with.position_sigma_m().norm() / 1.5e-3;
    let (with, without) = (smooth_rms(&Hand::USUAL, &with, 29), smooth_rms(&Hand::USUAL, &without, 29));
    println!("with bad readings {with:.3?}, without {without:.3?}, sigma found over sigma of the usual {sigma:.3}");
    assert!(with.0 < 1.02 * without.0 && with.1 < 1.02 * without.1 && (0.95..1.05).contains(&sigma));
}

#[test]
fn the_spacing_of_knots_does_not_choose_the_stiffness() {
    let readings = Tracker::PAPER.readings(&Hand::USUAL, 30, 3);
    let with = |knot_ms| SmoothTrajectory::fit(&readings, &Smoothing { knot_ms, ..Smoothing::default() }).unwrap();
    let (fine, coarse) = (with(20.0), with(50.0));
    let ratio = fine.lambda_position() / coarse.lambda_position() / 2.5f64.powi(5);
    println!("lambda over (d / d')^5: {ratio:.3}");
    assert!((0.7..1.4).contains(&ratio) && coarse.knot_nanos() == 50 * MS);
    let (fine, coarse) = (smooth_rms(&Hand::USUAL, &fine, 29), smooth_rms(&Hand::USUAL, &coarse, 29));
    assert!((fine.0 / coarse.0 - 1.0).abs() < 0.02 && (fine.1 / coarse.1 - 1.0).abs() < 0.02);
}

#[test]
fn what_cannot_be_smoothed_is_refused() {
    let readings = Tracker::PAPER.readings(&Hand::USUAL, 4, 3);
    let refused = |readings: &[TimedPose]| SmoothTrajectory::fit(readings, &Smoothing::default()).unwrap_err();
    for few in [0, 1, 7] {
        assert_eq!(refused(&readings[..few]), SmoothError::TooFew { usable: few, needed: 8 });
    }
    let mixed: Vec<TimedPose> = readings[..200].iter().zip(&readings[200..]).flat_map(|(a, b)| [*a, *b]).collect();
    assert!(matches!(refused(&mixed), SmoothError::Backwards { of: 400, .. }));
    let mut some = readings.clone();
    some[20].stamp_nanos = i64::MAX;
    some[50].stamp_nanos = i64::MIN;
    some[90].stamp_nanos = 0;
    some[120].pose.translation.x = f64::INFINITY;
    some[130].pose.rotation = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(f64::NAN, 0.0, 0.0, 1.0));
    some[140].pose.rotation = UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(0.0, 0.0, 0.0, 0.0));
    let way = fit(&some);
    assert_eq!(way.counts(), SmoothCounts { readings: 400, not_finite: 3, backwards: 3, ..SmoothCounts::default() });
    let config = Smoothing { outlier_sigmas: f64::NAN, ..Smoothing::default() };
    assert!(matches!(
        SmoothTrajectory::fit(&readings, &config),
        Err(SmoothError::Config { key: "outlier_sigmas", .. })
    ));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn whatever_comes_is_smoothed_or_refused(
        readings in proptest::collection::vec((0i64..3_000_000_000, -1e9..1e9f64, any::<f64>(), any::<bool>()), 0..60),
        far in any::<i64>(),
    ) {
        let reading = |(i, &(stamp, x, sigma, wild)): (usize, &(i64, f64, f64, bool))| TimedPose {
            stamp_nanos: if i % 17 == 0 { far.wrapping_add(stamp) } else { stamp / 4 + i as i64 * 50 * MS },
            pose: Isometry3::translation(if wild { x } else { 0.1 }, sigma, 0.0),
            position_sigma_m: sigma,
            rotation_sigma_rad: sigma,
        };
        let readings: Vec<TimedPose> = readings.iter().enumerate().map(reading).collect();
        if let Ok(way) = SmoothTrajectory::fit(&readings, &Smoothing::default()) {
            let (from, until) = way.span_nanos();
            for stamp in [from, until, from / 2 + until / 2, far, i64::MIN, i64::MAX] {
                let finite = |pose: Isometry3<f64>| pose.to_homogeneous().iter().all(|value| value.is_finite());
                prop_assert!(way.at(stamp).is_none_or(finite));
            }
        }
    }
}
