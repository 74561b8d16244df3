//! What goes out while a scan goes on: what changed, and what the hand should still do.

#![allow(clippy::unwrap_used, reason = "tests")]

mod swept;

use nalgebra::Point3;
use refine::{Config, Notice, Refinement, Refiner, Shown};
use std::collections::BTreeMap;
use swept::{Spec, Sweep};
use wire::Scan;

const SECOND: i64 = 1_000_000_000;

/// A tick each second, as it goes while the scan is on.
fn ticks(sweep: &Sweep, mut each: impl FnMut(i64, Refinement)) {
    let mut refiner = Refiner::new(Config::default(), &sweep.calibration).unwrap();
    let (mut poses, mut profiles) = (sweep.poses.iter().peekable(), sweep.profiles.iter().peekable());
    for second in 1..=sweep.seconds as i64 {
        let until = second * SECOND;
        std::iter::from_fn(|| poses.next_if(|pose| pose.header.stamp_nanos < until)).for_each(|p| refiner.pose(p));
        std::iter::from_fn(|| profiles.next_if(|p| p.header.stamp_nanos < until)).for_each(|p| refiner.profile(p));
        if let Some(refinement) = refiner.tick() {
            each(second, refinement);
        }
    }
}

/// A frame that came behind the refinement, as register has it.
fn relayed(sweep: &Sweep, second: i64) -> Scan {
    let late = sweep.smoothed().into_iter().find(|scan| scan.header.stamp_nanos > second * SECOND);
    late.filter(|scan| !scan.points.is_empty()).unwrap()
}

#[test]
fn readers_that_take_what_changed_have_the_whole_refinement() {
    const MOVED_M: f64 = 2e-4;
    let sweep = Sweep::new(&Spec { seconds: 14.0, rays: 100, ..Spec::named("P", 1) });
    let (mut shown, mut held) = (Shown::default(), BTreeMap::new());
    let (mut sent, mut all, mut revisions) = (0, 0, 0);
    ticks(&sweep, |second, refinement| {
        let first = shown.is_empty();
        let changes = shown.changes(&refinement, MOVED_M);
        assert!(changes.is_sorted_by_key(|scan| scan.header.stamp_nanos), "in the order of the stamps");
        assert_eq!(first, held.is_empty());
        // What readers do with it: a frame takes its own place.
        for scan in changes {
            sent += usize::from(!scan.points.is_empty());
            held.insert(scan.header.stamp_nanos, scan);
        }
        assert!(shown.changes(&refinement, MOVED_M).is_empty(), "it is said once");
        let wanted: BTreeMap<i64, Scan> = refinement.scans().map(|scan| (scan.header.stamp_nanos, scan)).collect();
        let last = refinement.evidence.last_frame_nanos().unwrap();
        let stands: Vec<i64> =
            held.range(..=last).filter(|(_, scan)| !scan.points.is_empty()).map(|(stamp, _)| *stamp).collect();
        assert!(stands.iter().eq(wanted.keys()), "kept frames are there, and left-out ones are not");
        for (stamp, scan) in &wanted {
            let points = scan.points.iter().zip(held[stamp].points.iter());
            let off = |(a, b): (&wire::ScanPoint, &wire::ScanPoint)| {
                (Point3::from(a.position_m) - Point3::from(b.position_m)).norm()
            };
            let worst_m = points.map(off).fold(0.0, f32::max);
            assert!(f64::from(worst_m) < 1.001 * MOVED_M, "at {second} s a point stands {worst_m} m off");
        }
        (all, revisions) = (all + wanted.len(), revisions + 1);
        // One that comes while the next tick is computed.
        if second == 9 {
            let late = relayed(&sweep, second);
            shown.relayed(&late);
            held.insert(late.header.stamp_nanos, late);
        }
    });
    println!("{sent} of {all} frames were sent in {revisions} revisions");
    assert!(revisions > 10 && sent < all);
}

#[test]
fn a_frame_behind_the_refinement_stays_until_it_is_refined() {
    let sweep = Sweep::new(&Spec { seconds: 5.0, rays: 60, ..Spec::named("W", 1) });
    let (mut shown, mut late) = (Shown::default(), None);
    ticks(&sweep, |second, refinement| {
        let changes = shown.changes(&refinement, 2e-4);
        if second == 4 {
            let scan = relayed(&sweep, second);
            shown.relayed(&scan);
            assert!(shown.changes(&refinement, 2e-4).is_empty(), "nothing is known of it yet");
            late = Some(scan.header.stamp_nanos);
        } else if let Some(late) = late {
            assert!(changes.iter().any(|scan| scan.header.stamp_nanos == late), "the tracker had it elsewhere");
        }
    });
    assert!(late.is_some());
}

/// The moments at which the hand is told to cross its strokes.
fn told(sweep: &Sweep) -> Vec<i64> {
    let mut told = Vec::new();
    ticks(sweep, |second, refinement| {
        let crosses = |notice: &Notice| matches!(notice, Notice::StrokesDoNotCross { .. });
        let observed = refinement.evidence.observed.map(|observed| observed.crossing);
        println!("{second} s: {observed:?} {:?}", refinement.evidence.notices);
        assert!(second < 7 || observed.is_some());
        told.extend(refinement.evidence.notices.iter().any(crosses).then_some(second));
    });
    told
}

#[test]
fn a_missing_stroke_is_named_while_the_hand_still_moves() {
    let scene = format!("{}/../../config/scenes/one_way.toml", env!("CARGO_MANIFEST_DIR"));
    let scene = Box::leak(std::fs::read_to_string(scene).unwrap().into_boxed_str());
    for tracker in ["P", "C"] {
        let sweep = Sweep::new(&Spec { seconds: 40.0, rays: 100, scene, ..Spec::named(tracker, 1) });
        let told = told(&sweep);
        assert!(told.first().is_some_and(|first| *first >= 10), "{tracker}: {told:?}");
    }
}

#[test]
fn a_hand_that_crosses_its_strokes_is_told_nothing() {
    for (tracker, seed) in [("P", 1), ("P", 2), ("C", 3)] {
        let sweep = Sweep::new(&Spec { seconds: 34.0, rays: 100, ..Spec::named(tracker, seed) });
        let told = told(&sweep);
        assert!(told.is_empty(), "{tracker} {seed}: {told:?}");
    }
}
