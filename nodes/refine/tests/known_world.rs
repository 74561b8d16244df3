//! The known world, swept with the trackers of the table in the handbook's issue: how far the refined points are from the
//! truth. What stands in the assertions is some 20 % above what was measured over seeds 1 to 3.

#![allow(clippy::unwrap_used, reason = "tests")]

mod swept;

use nalgebra::Vector3;
use refine::{Config, Notice, Refinement, Refiner};
use swept::{Spec, Sweep, measure};
use wire::Scan;

struct Result {
    refinement: Refinement,
    scans: Vec<Scan>,
    fit: measure::Fit,
    smoothed: measure::Fit,
    coverage: [f64; 2],
}

fn refined(sweep: &Sweep) -> Result {
    let refinement = sweep.refiner(Config::default()).finish().unwrap();
    let scans: Vec<Scan> = refinement.scans().collect();
    let (fit, smoothed) = (measure::fit(sweep, &scans), measure::fit(sweep, &sweep.smoothed()));
    println!("smoothed {smoothed}\nrefined  {fit}");
    let [inliers, outliers] = measure::left_out(sweep, &scans);
    println!("left out: {inliers:.4} of the inliers, {outliers:.3} of the outliers");
    assert!(inliers < 0.006, "{inliers} of the inliers were left out");
    let coverage = measure::coverage(sweep, &scans);
    Result { refinement, scans, fit, smoothed, coverage }
}

fn named(name: &str) -> Spec {
    Spec { rays: 130, ..Spec::named(name, 1) }
}

#[test]
fn perfect_poses_stay_at_the_noise() {
    let result = refined(&Sweep::new(&Spec { seconds: 30.0, ..named("perfect") }));
    assert!(result.fit.rms < 1.2 * result.smoothed.rms && result.fit.p95 < 1.1 * result.smoothed.p95);
    assert!(result.refinement.evidence.dropped.len() * 50 < result.scans.len());
}

#[test]
fn white_noise_of_three_degrees_leaves_a_tenth_of_a_millimetre() {
    let result = refined(&Sweep::new(&named("W")));
    assert!(result.smoothed.rms > 1.0);
    assert!(result.fit.rms < 0.15 && result.fit.p95 < 0.25, "{}", result.fit);
    assert!(result.refinement.evidence.dropped.len() < 60);
    // The stated sigma holds.
    let [one, two] = result.coverage;
    assert!((0.6..0.9).contains(&one) && (0.9..0.99).contains(&two), "{one} {two}");
}

/// What no number of pictures averages away is stated as well.
#[test]
fn whole_regions_stand_off_by_what_is_stated_of_them() {
    for tracker in ["W", "P", "C"] {
        let sweep = Sweep::new(&named(tracker));
        let regions = measure::regions(&sweep, &refined(&sweep).scans);
        let within =
            regions.iter().filter(|[off, sigma]| off.abs() <= 2.0 * sigma).count() as f64 / regions.len() as f64;
        let rms_mm = |i: usize| (regions.iter().map(|r| r[i] * r[i]).sum::<f64>() / regions.len() as f64).sqrt() * 1e3;
        let (off, stated) = (rms_mm(0), rms_mm(1));
        println!("{tracker}: {} regions, rms {off:.3} of {stated:.3} mm, {within:.2} within two sigma", regions.len());
        assert!(regions.len() > 100 && (0.6..1.4).contains(&(off / stated)) && within > 0.9, "{off} {stated} {within}");
    }
}

#[test]
fn a_scan_of_twenty_seconds_is_held_by_what_is_known_of_hands() {
    for seed in [1, 2] {
        let sweep = Sweep::new(&Spec { seconds: 20.0, ..Spec::named("P", seed) });
        let result = refined(&sweep);
        assert!(result.fit.thing_rms < 0.5, "{}", result.fit);
        assert!(result.refinement.evidence.frames_on_table > 40, "the table has its say");
    }
}

#[test]
fn a_bent_field_with_a_wrong_clock_and_a_wrong_hand_eye_is_undone_and_the_clock_found() {
    let result = refined(&Sweep::new(&named("M")));
    assert!(result.smoothed.rms > 2.0);
    assert!(result.fit.rms < 0.14, "{}", result.fit);
    let clock = result.refinement.evidence.clock;
    assert!((clock.tau_ms - 15.0).abs() < 1.5, "{clock:?}");
    assert!((clock.tau_ms - 15.0).abs() < 4.0 * clock.sigma_ms.unwrap(), "{clock:?}");
}

#[test]
fn orientations_that_are_older_than_said_are_found_when_they_are_asked_for() {
    let mut sweep = Sweep::new(&Spec { seconds: 40.0, ..named("C") });
    let turned: Vec<[f64; 4]> = sweep.poses.iter().map(|pose| pose.world_from_body.rotation_wxyz).collect();
    sweep.poses.drain(..2);
    sweep.poses.iter_mut().zip(turned).for_each(|(pose, rotation)| pose.world_from_body.rotation_wxyz = rotation);
    let refined = |rotation_lag_ms: f64| {
        let refinement = sweep.refiner(Config { rotation_lag_ms, ..Config::default() }).finish().unwrap();
        let fit = measure::fit(&sweep, &refinement.scans().collect::<Vec<_>>());
        (refinement.evidence.clock, fit.rms)
    };
    let ((held, without), (clock, with)) = (refined(0.0), refined(30.0));
    println!("{without:.3} {held:?}\n{with:.3} {clock:?}");
    assert_eq!((held.rotation_lag_ms, held.rotation_lag_sigma_ms), (0.0, None));
    assert!((clock.rotation_lag_ms - 20.0).abs() < 1.5 && clock.tau_ms.abs() < 1.5, "{clock:?}");
    assert!(with < without, "{with} {without}");
}

#[test]
fn a_strong_field_is_undone() {
    let result = refined(&Sweep::new(&named("C")));
    assert!(result.fit.rms < 0.13, "{}", result.fit);
}

#[test]
fn noise_that_lasts_is_noticed_and_undone() {
    let result = refined(&Sweep::new(&named("O")));
    let notices = &result.refinement.evidence.notices;
    assert!(notices.iter().any(|notice| matches!(notice, Notice::ColouredNoise { .. })), "{notices:?}");
    assert!(result.fit.rms < 0.30, "{}", result.fit);
}

/// The calibration is wrong by so much that no belief in it allows for it: said, and held fast instead of run away with.
#[test]
fn a_hand_eye_transform_that_runs_away_is_held_and_said() {
    let sweep = Sweep::new(&Spec { hand_eye_error: [16.0, 0.0], ..named("C") });
    let refinement = sweep.refiner(Config::default()).finish().unwrap();
    let evidence = &refinement.evidence;
    let Some(Notice::HandEyeRanAway { shift_mm, .. }) = evidence.notices.first() else {
        panic!("{:?}", evidence.notices)
    };
    assert!(shift_mm.iter().any(|mm| mm.abs() > 6.0), "{shift_mm:?}");
    assert!(!evidence.hand_eye.freed && evidence.hand_eye.shift_mm == [0.0; 3], "{:?}", evidence.hand_eye);
    let (before, after) =
        (measure::fit(&sweep, &sweep.smoothed()), measure::fit(&sweep, &Vec::from_iter(refinement.scans())));
    assert!(after.rms < before.rms, "{before} {after}");
}

/// Without strokes that cross there is less to hold on to, but what smoothing gave is not lost.
#[test]
fn strokes_in_one_direction_are_no_worse_than_smoothing_and_the_missing_one_is_named() {
    for tracker in ["W", "M"] {
        let result = refined(&Sweep::new(&Spec { one_way: true, ..named(tracker) }));
        let notices = &result.refinement.evidence.notices;
        assert!(
            notices.iter().any(|notice| matches!(notice, Notice::StrokesDoNotCross { .. })),
            "{tracker}: {notices:?}"
        );
        assert!(result.fit.rms < 1.02 * result.smoothed.rms, "{tracker}: {} {}", result.fit, result.smoothed);
    }
}

#[test]
fn a_thing_that_is_shoved_is_noticed_with_its_moment() {
    let pushed = Some((36.0, Vector3::new(15e-3, 10e-3, 0.0)));
    let sweep = Sweep::new(&Spec { pushed, ..named("C") });
    let refinement = sweep.refiner(Config::default()).finish().unwrap();
    let notices = &refinement.evidence.notices;
    let Some(Notice::ThingMoved { stamp_nanos, apart_mm }) = notices.first() else { panic!("{notices:?}") };
    assert!((*stamp_nanos as f64 * 1e-9 - 36.0).abs() < 3.0, "{stamp_nanos}");
    assert!(*apart_mm > 0.3);
}

#[test]
fn the_result_is_the_same_bytes_on_one_thread_and_on_three() {
    let sweep = Sweep::new(&Spec { seconds: 20.0, ..named("W") });
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut refiner = sweep.refiner(Config::default());
            let live: Vec<_> = (0..2).map(|_| refiner.tick().unwrap().trajectory).collect();
            let last = refiner.finish().unwrap();
            let evidence = serde_json::to_string(&last.evidence).unwrap();
            (live, last.scans().collect::<Vec<_>>(), last.trajectory, evidence)
        })
    };
    assert!(run(1) == run(3));
}

#[test]
fn live_ticks_are_no_worse_than_the_smoothed_tracker_and_grow_better() {
    let sweep = Sweep::new(&Spec { seconds: 24.0, ..named("W") });
    let mut refiner = Refiner::new(Config::default(), &sweep.calibration).unwrap();
    let (mut poses, mut profiles) = (sweep.poses.iter().peekable(), sweep.profiles.iter().peekable());
    let mut rms = Vec::new();
    for second in 1..=24 {
        let until = second * 1_000_000_000;
        while let Some(pose) = poses.next_if(|pose| pose.header.stamp_nanos < until) {
            refiner.pose(pose);
        }
        while let Some(profile) = profiles.next_if(|profile| profile.header.stamp_nanos < until) {
            refiner.profile(profile);
        }
        let tick = refiner.tick();
        assert_eq!(tick.is_some(), second > 2);
        if second % 12 == 0 {
            let scans: Vec<Scan> = tick.unwrap().scans().collect();
            let smoothed = sweep.smoothed().into_iter().filter(|s| s.header.stamp_nanos < until).collect::<Vec<_>>();
            rms.push([measure::fit(&sweep, &smoothed).rms, measure::fit(&sweep, &scans).rms]);
        }
    }
    println!("{rms:?}");
    assert!(rms.iter().all(|[smoothed, live]| live < smoothed));
    assert!(rms[1][1] < 0.6 * rms[1][0], "{rms:?}");
}

#[test]
fn the_way_between_frames_is_the_way_of_the_frames() {
    let sweep = Sweep::new(&Spec { seconds: 20.0, ..named("W") });
    let refinement = sweep.refiner(Config::default()).finish().unwrap();
    let mut buffer = geometry::TrajectoryBuffer::default();
    assert!(refinement.trajectory.iter().all(|pose| buffer.push(*pose)));
    for scan in refinement.scans().step_by(7) {
        let between = buffer.at(scan.header.stamp_nanos, 10_000_000).unwrap();
        let own = geometry::rigid_from_wire(&scan.world_from_camera).unwrap();
        let off = between.pose.inv_mul(&own);
        assert!(off.translation.vector.norm() < 5e-6 && off.rotation.angle() < 5e-5, "{off}");
    }
}
