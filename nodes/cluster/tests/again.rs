//! Pictures that come again, better placed.

use cluster::{BallClusterer, Config};
use proptest::prelude::*;
use std::collections::BTreeMap;
use wire::{Cloud, CloudPoint, Extent, Header, Phase, Scan, ScanPoint};

const D: f32 = 1e-3;

fn config() -> Config {
    Config { ball_radius_m: f64::from(D), least_points: 3, ..Config::default() }
}

fn clusterer() -> BallClusterer {
    BallClusterer::new(config()).expect("a good configuration")
}

fn picture(revision: u32, extent: Extent, stamp_nanos: i64, places: &[[f32; 3]]) -> Scan {
    let point =
        |&position_m: &[f32; 3]| ScanPoint { position_m, to_sensor: [0.0, 0.0, 1.0], sigma_m: 1e-4, amplitude: 1.0 };
    let points = places.iter().map(point).collect();
    Scan { points, extent, ..Scan::none(Header { phase: Phase::Shape, revision, stamp_nanos, ..Header::default() }) }
}

/// A stripe over a plane at this height.
fn stripe(k: i64, z: f32) -> Vec<[f32; 3]> {
    (0..60).map(|i| [0.4 * D * i as f32, 0.3 * D * k as f32, z + 0.02 * D * ((7 * i + 3 * k) % 5) as f32]).collect()
}

fn heights(cloud: &Cloud) -> [f32; 2] {
    let heights = cloud.points.iter().map(|p| p.position_m[2]);
    heights.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], z| [low.min(z), high.max(z)])
}

#[test]
fn a_picture_that_comes_again_takes_its_own_place() {
    let mut clusterer = clusterer();
    // Every second picture stands 5 mm too high.
    let height = |k: i64| if k % 2 == 0 { 0.0 } else { 5.0 * D };
    (0..100).for_each(|k| clusterer.insert(&picture(1, Extent::Whole, k, &stripe(k, height(k)))));
    let first = clusterer.changes();
    assert_eq!(first.extent, Extent::Whole);
    assert!(heights(&first)[1] > 4.9 * D);
    for k in (1..100).step_by(2) {
        clusterer.insert(&picture(2, Extent::Changes, k, &stripe(k, 0.0)));
    }
    let changes = clusterer.changes();
    assert_eq!((changes.extent, changes.header.revision), (Extent::Changes, 2));
    let gone: Vec<&CloudPoint> = changes.points.iter().filter(|ball| ball.count == 0).collect();
    assert!(!gone.is_empty() && gone.iter().all(|ball| ball.position_m[2] > 4.0 * D), "balls without points are told");
    let whole = clusterer.whole();
    assert!(heights(&whole)[1] < D, "{:?}", heights(&whole));
    assert_eq!(clusterer.held().points, 6000);
    // About as many witnesses as if it had been right at once (the balls lie otherwise), and none twice.
    let mut at_once = BallClusterer::new(config()).expect("a good configuration");
    (0..100).for_each(|k| at_once.insert(&picture(1, Extent::Whole, k, &stripe(k, 0.0))));
    let mean_sigma_m = |cloud: &Cloud| cloud.points.iter().map(|p| p.sigma_m).sum::<f32>() / cloud.points.len() as f32;
    let ratio = mean_sigma_m(&whole) / mean_sigma_m(&at_once.whole());
    assert!((0.9..1.3).contains(&ratio), "{ratio}");
}

#[test]
fn a_picture_without_points_is_taken_back_and_a_whole_revision_forgets_all() {
    let mut clusterer = clusterer();
    (0..20).for_each(|k| clusterer.insert(&picture(1, Extent::Whole, k, &stripe(k, 0.0))));
    (0..10).for_each(|k| clusterer.insert(&picture(2, Extent::Changes, k, &[])));
    assert_eq!(clusterer.held().points, 600);
    clusterer.insert(&picture(2, Extent::Changes, 20, &stripe(20, 0.0)));
    assert_eq!(clusterer.held().points, 660, "a new one is added");
    let mut afresh = BallClusterer::new(config()).expect("a good configuration");
    for k in 0..20 {
        let scan = picture(3, Extent::Whole, k, &stripe(k, 0.001));
        clusterer.insert(&scan);
        afresh.insert(&scan);
    }
    assert_eq!(clusterer.whole(), afresh.whole(), "nothing is left of what was before");
}

/// Some pictures of points in a volume.
fn pictures() -> impl Strategy<Value = Vec<Vec<[f32; 3]>>> {
    let places = prop::collection::vec(prop::array::uniform3(-2.0 * D..2.0 * D), 0..40);
    prop::collection::vec(places, 1..8)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn what_is_taken_back_leaves_no_point_behind(first in pictures(), then in pictures()) {
        let mut clusterer = clusterer();
        let mut held = BTreeMap::new();
        for (revision, extent, pictures) in [(1, Extent::Whole, &first), (2, Extent::Changes, &then)] {
            for (k, places) in pictures.iter().enumerate() {
                clusterer.insert(&picture(revision, extent, k as i64, places));
                held.insert(k, places.len() as u64);
            }
        }
        prop_assert_eq!(clusterer.held().points, held.values().sum::<u64>());
        // Every point can be let go again.
        for k in 0..8 {
            clusterer.insert(&picture(3, Extent::Changes, k, &[]));
        }
        prop_assert_eq!(clusterer.held().points, 0);
        prop_assert!(clusterer.whole().points.is_empty());
    }

    #[test]
    fn the_changes_add_up_to_the_whole(first in pictures(), then in pictures()) {
        let mut clusterer = clusterer();
        let mut known = BTreeMap::new();
        for (revision, extent, pictures) in [(1, Extent::Whole, &first), (2, Extent::Changes, &then)] {
            for (k, places) in pictures.iter().enumerate() {
                clusterer.insert(&picture(revision, extent, k as i64, places));
                for ball in clusterer.changes().points.iter() {
                    if ball.count > 0 { known.insert(ball.id, *ball); } else { known.remove(&ball.id); }
                }
            }
        }
        let whole = clusterer.whole();
        let told: Vec<(u32, u32, [f32; 3])> = known.values().map(|p| (p.id, p.count, p.position_m)).collect();
        prop_assert_eq!(told, whole.points.iter().map(|p| (p.id, p.count, p.position_m)).collect::<Vec<_>>());
    }
}
