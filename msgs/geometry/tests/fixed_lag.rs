//! The smooth way while readings come, against a hand that is known exactly.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod hand;

use geometry::{FixedLagSmoother, NoPose, Smoothing, TimedPose, Wait};
use hand::{Hand, MS, Noise, Tracker, rms};
use proptest::prelude::*;

const EDGE: Wait = Wait { lag_nanos: 0, predict_nanos: 0 };

fn wait(lag_ms: i64, predict_ms: i64) -> Wait {
    Wait { lag_nanos: lag_ms * MS, predict_nanos: predict_ms * MS }
}

fn smoother(readings: &[TimedPose]) -> FixedLagSmoother {
    let mut smoother = FixedLagSmoother::new(Smoothing::default()).unwrap();
    readings.iter().for_each(|reading| assert!(smoother.push(reading, 0)));
    smoother
}

/// From the second second on, at 60 frames a second.
fn frames(seconds: i64) -> impl Iterator<Item = i64> {
    (60..(seconds - 1) * 60).map(|i| i * 16_666_667 + 3 * MS)
}

fn live_rms(hand: &Hand, smoother: &FixedLagSmoother, wait: &Wait, seconds: i64) -> (f64, f64) {
    rms(hand, frames(seconds).map(|stamp| (stamp, smoother.at(stamp, wait).unwrap().pose)))
}

/// The rms of the sigmas that are stated, as lengths of vectors in mm and degrees.
fn stated_rms(smoother: &FixedLagSmoother, wait: &Wait, seconds: i64) -> (f64, f64) {
    let square = |pose: TimedPose| (3.0 * pose.position_sigma_m.powi(2), 3.0 * pose.rotation_sigma_rad.powi(2));
    let all = frames(seconds).map(|stamp| square(smoother.at(stamp, wait).unwrap()));
    let sum = all.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    let count = frames(seconds).count() as f64;
    ((sum.0 / count).sqrt() * 1e3, (sum.1 / count).sqrt().to_degrees())
}

#[test]
fn each_lag_gains_and_states_what_it_gained() {
    for (name, tracker) in [("paper", Tracker::PAPER), ("fine", Tracker::FINE)] {
        let readings = tracker.readings(&Hand::USUAL, 40, 3);
        let smoother = smoother(&readings);
        let mut before = rms(&Hand::USUAL, readings.iter().map(|r| (r.stamp_nanos, r.pose)));
        println!("{name}: raw {before:.4?} mm, degrees");
        for (lag_ms, predict_ms) in [(0, 10), (0, 0), (20, 0), (50, 0), (100, 0), (300, 0)] {
            let wait = wait(lag_ms, predict_ms);
            let (found, stated) = (live_rms(&Hand::USUAL, &smoother, &wait, 40), stated_rms(&smoother, &wait, 40));
            println!("  lag {lag_ms} ms, predict {predict_ms} ms: {found:.4?}, stated {stated:.4?}");
            for (found, stated) in [(found.0, stated.0), (found.1, stated.1)] {
                assert!((0.8..1.25).contains(&(found / stated)), "{found} {stated}");
            }
            assert!(found.0 < 1.05 * before.0 && found.1 < 1.05 * before.1);
            before = found;
        }
    }
}

/// Moments that share a fit are as good as if each had waited by itself.
#[test]
fn settled_moments_share_a_fit() {
    let readings = Tracker::PAPER.readings(&Hand::USUAL, 20, 3);
    let (smoother, hand) = (smoother(&readings), Hand::USUAL);
    let moments: Vec<i64> =
        readings.iter().map(|r| r.stamp_nanos).filter(|t| (1000..19_000).contains(&(t / MS))).collect();
    let (mut found, mut rest) = (Vec::new(), &moments[..]);
    while !rest.is_empty() {
        let settled = smoother.settled(rest, 250 * MS).unwrap();
        assert!((1..=5).contains(&settled.len()), "readings come every 10 ms, fits every 50");
        found.extend(rest.iter().zip(settled).map(|(stamp, pose)| (*stamp, pose.unwrap().pose)));
        rest = &rest[found.len() - (moments.len() - rest.len())..];
    }
    assert_eq!(found.len(), moments.len());
    let alone = moments.iter().map(|stamp| (*stamp, smoother.at(*stamp, &wait(275, 0)).unwrap().pose));
    let (together, alone) = (rms(&hand, found.into_iter()), rms(&hand, alone));
    assert!(together.0 < 1.02 * alone.0 && together.1 < 1.02 * alone.1, "{together:?} {alone:?}");
    assert_eq!(smoother.settled(&[19_800 * MS], 250 * MS), Err(NoPose::After));
    assert_eq!(smoother.settled(&[], 250 * MS), Ok(vec![]));
    assert_eq!(smoother.settled(&[-50 * MS], 250 * MS), Ok(vec![Err(NoPose::Before)]));
    assert_eq!(smoother.settled(&[i64::MIN, i64::MAX], 250 * MS), Ok(vec![Err(NoPose::Before)]));
    assert_eq!(smoother.settled(&[i64::MAX], i64::MAX), Err(NoPose::After));
}

#[test]
fn a_noisy_tracker_is_predicted_and_a_fine_one_waited_for() {
    // 3 ms behind a reading, 7 ms before the next.
    let stamp = 5003 * MS;
    for (tracker, early) in [(Tracker::PAPER, true), (Tracker::FINE, false)] {
        let readings = tracker.readings(&Hand::USUAL, 6, 3);
        let known = smoother(&readings[..501]);
        assert_eq!(known.newest(), Some(5000 * MS));
        assert_eq!(known.at(stamp, &EDGE), Err(NoPose::After));
        assert_eq!(known.at(stamp, &wait(0, 10)).is_ok(), early);
        assert_eq!(known.at(stamp, &wait(0, 2)), Err(NoPose::After), "3 ms are more than 2");
        assert!(smoother(&readings[..502]).at(stamp, &wait(0, 10)).is_ok());
        assert_eq!(smoother(&readings[..502]).at_end(5011 * MS), Err(NoPose::After));
    }
}

#[test]
fn a_rotation_that_is_older_than_its_position_is_taken_at_its_own_moment() {
    let still = Hand { tremor_m: 0.0, tremor_deg: 0.0 };
    let (mut noise, lag) = (Noise(4), 25 * MS);
    let mut smoother = FixedLagSmoother::new(Smoothing::default()).unwrap();
    for i in 0..1000 {
        let position = Tracker::PAPER.read(&still, i * 10 * MS, &mut noise);
        let turned = Tracker::PAPER.read(&still, i * 10 * MS - lag, &mut noise);
        let pose = nalgebra::Isometry3::from_parts(position.pose.translation, turned.pose.rotation);
        smoother.push(&TimedPose { pose, ..position }, lag);
    }
    let found = live_rms(&still, &smoother, &wait(100, 0), 10);
    println!("rotation 25 ms older: {found:.3?}");
    assert!(found.0 < 0.6 && found.1 < 0.9, "{found:?}");
}

#[test]
fn silence_outliers_and_the_first_readings() {
    let mut readings = Tracker::PAPER.readings(&Hand::USUAL, 12, 8);
    readings.retain(|r| {
        !(4000 * MS..4500 * MS).contains(&r.stamp_nanos) && !(7000 * MS..9000 * MS).contains(&r.stamp_nanos)
    });
    // Without the first two seconds, where the smoother learns.
    for outlier in [300, 302, 303, 420, 550, 551] {
        readings[outlier].pose.translation.x += 0.2;
        readings[outlier].pose.rotation = readings[outlier].pose.rotation.inverse();
    }
    let smoother = smoother(&readings);
    assert_eq!(smoother.at(-MS, &EDGE), Err(NoPose::Before));
    for silent in [4000, 4200, 4499, 7500] {
        assert_eq!(smoother.at(silent * MS, &EDGE), Err(NoPose::Gap));
        assert_eq!(smoother.at_end(silent * MS), Err(NoPose::Gap));
    }
    let at = |range: std::ops::Range<i64>| {
        let poses = range.step_by(7).map(|ms| (ms * MS, smoother.at(ms * MS, &EDGE).unwrap().pose));
        rms(&Hand::USUAL, poses)
    };
    for (name, range) in [
        ("first", 1..160),
        ("outliers", 2900..3980),
        ("outlier", 5450..5550),
        ("behind a silence", 4500..4900),
        ("again", 9000..9400),
    ] {
        let found = at(range);
        println!("{name}: {found:.3?}");
        assert!(found.0 < 1.5 && found.1 < 3.0, "{name}: {found:?}");
    }
    let mut smoother = smoother;
    let before = smoother.at(11_003 * MS, &EDGE);
    smoother.forget_before(11_000 * MS);
    assert!(smoother.oldest() > Some(5000 * MS) && smoother.at(11_003 * MS, &EDGE) == before);
}

#[test]
fn readings_that_are_none() {
    let mut smoother = FixedLagSmoother::new(Smoothing::default()).unwrap();
    assert_eq!((smoother.at(0, &EDGE), smoother.at_end(0)), (Err(NoPose::After), Err(NoPose::After)));
    let good = Tracker::PAPER.readings(&Hand::USUAL, 1, 1)[0];
    let mut not_finite = good;
    not_finite.pose.translation.y = f64::NAN;
    assert!(!smoother.push(&not_finite, 0) && smoother.push(&good, 0) && !smoother.push(&good, 0));
    assert_eq!(smoother.at(0, &EDGE).unwrap().pose, good.pose, "one reading is what it is");
    assert!(smoother.push(&TimedPose { stamp_nanos: i64::MAX, ..good }, i64::MAX));
    assert_eq!(smoother.at(5, &EDGE), Err(NoPose::After), "the second rotation is not later");
    assert!(FixedLagSmoother::new(Smoothing { knot_ms: 0.0, ..Smoothing::default() }).is_err());
}

/// Readings with everything that comes: jitter, silences, outliers, rotations of another moment.
fn ugly(seed: u64) -> Vec<(TimedPose, i64)> {
    let mut noise = Noise(seed);
    let mut stamp = 0;
    let reading = |_| {
        stamp += MS + (noise.uniform() * 18e6) as i64;
        if noise.uniform() < 0.01 {
            stamp += (noise.uniform() * 2e9) as i64;
        }
        let mut reading = Tracker::PAPER.read(&Hand::USUAL, stamp, &mut noise);
        if noise.uniform() < 0.02 {
            reading.pose.translation.x += noise.gaussian();
        }
        (reading, if seed.is_multiple_of(2) { 0 } else { (noise.uniform() * 40e6) as i64 })
    };
    (0..250).map(reading).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn an_answer_does_not_depend_on_when_it_is_asked(seed in any::<u64>(), lag_ms in 0..60i64, predict_ms in 0..20i64) {
        let wait = wait(lag_ms, predict_ms);
        let (mut live, mut late) = (FixedLagSmoother::new(Smoothing::default()).unwrap(), FixedLagSmoother::new(Smoothing::default()).unwrap());
        let readings = ugly(seed);
        readings.iter().for_each(|(reading, lag)| { late.push(reading, *lag); });
        let frames: Vec<i64> = (0..).map(|i| i * 33 * MS).take_while(|stamp| Some(*stamp) < late.newest()).collect();
        let mut asked = frames.iter().copied().peekable();
        for (reading, lag) in &readings {
            live.push(reading, *lag);
            while let Some(stamp) = asked.peek().copied() {
                let answer = live.at(stamp, &wait);
                if answer == Err(NoPose::After) { break }
                prop_assert_eq!(answer, late.at(stamp, &wait));
                asked.next();
            }
            let settled = live.settled(&frames, wait.lag_nanos);
            prop_assert!(settled == Err(NoPose::After) || settled == late.settled(&frames, wait.lag_nanos));
        }
        for stamp in asked {
            prop_assert_eq!(late.at(stamp, &wait), Err(NoPose::After));
            prop_assert_eq!(late.at_end(stamp), live.at_end(stamp));
        }
    }
}
