//! What a ball says of itself, and what is refused.

use cluster::{BallClusterer, Config, ConfigError, Table};
use proptest::prelude::*;
use wire::{Extent, Header, Phase, Scan, ScanPoint};

const RADIUS_M: f32 = 0.05;
const NOISE_M: f32 = 1e-4;

fn scan(revision: u32, points: Vec<ScanPoint>) -> Scan {
    Scan {
        points: points.into(),
        ..Scan::none(Header { phase: Phase::Shape, revision, stamp_nanos: 5, ..Header::default() })
    }
}

fn point(position_m: [f32; 3]) -> ScanPoint {
    ScanPoint { position_m, to_sensor: [0.0, 0.0, 1.0], sigma_m: NOISE_M, amplitude: 50.0 }
}

/// A number in -1..1 that looks random.
fn noise(i: usize, k: usize) -> f32 {
    let h = (i as u64 * 7 + k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let h = (h ^ (h >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((h >> 40) as f32) / (1u64 << 23) as f32 - 1.0
}

/// Points on the upper half of a ball, with noise along the radius (uniform, so its sigma is NOISE_M), seen from above.
fn dome(count: usize) -> Vec<ScanPoint> {
    let on_dome = |i: usize| {
        let (z, turn) = (0.5 * (noise(i, 0) + 1.0), std::f32::consts::PI * noise(i, 1));
        let ring = (1.0 - z * z).sqrt();
        let r = RADIUS_M + NOISE_M * 3f32.sqrt() * noise(i, 2);
        point([r * ring * turn.cos(), r * ring * turn.sin(), r * z])
    };
    (0..count).map(on_dome).collect()
}

#[test]
fn on_a_ball_the_averages_are_closer_and_the_normals_point_out() {
    let mut clusterer =
        BallClusterer::new(Config { ball_radius_m: 1e-3, least_points: 5, ..Config::default() }).unwrap();
    clusterer.insert(&scan(0, dome(400_000)));
    let cloud = clusterer.whole();
    assert_eq!((cloud.extent, cloud.header.stamp_nanos), (Extent::Whole, 5));
    let mut squares = 0.0;
    let mut worst_angle_rad = 0.0f32;
    for p in cloud.points.iter() {
        let r = p.position_m.iter().map(|c| c * c).sum::<f32>().sqrt();
        squares += f64::from(r - RADIUS_M).powi(2);
        let cos = p.position_m.iter().zip(p.normal).map(|(a, b)| a * b).sum::<f32>() / r;
        // At the rim the sensor looks along the surface, and either side is as good.
        if p.position_m[2] > 0.2 * RADIUS_M {
            worst_angle_rad = worst_angle_rad.max(cos.clamp(-1.0, 1.0).acos());
        }
        assert!((p.normal.iter().map(|c| c * c).sum::<f32>() - 1.0).abs() < 1e-5);
        assert!(p.spread_m < 3.0 * NOISE_M && p.sigma_m >= NOISE_M * 0.99 / (p.count as f32).sqrt());
        assert_eq!(p.colour, [0; 4]);
    }
    let rms_m = (squares / cloud.points.len() as f64).sqrt();
    let points_per_ball = 400_000.0 / cloud.points.len() as f64;
    // Averaging wins the root of the count; a ball is also D^2 / 8R flatter than the surface.
    assert!(rms_m < 1.3 * f64::from(NOISE_M) / points_per_ball.sqrt() + 3e-6, "{rms_m} with {points_per_ball} a ball");
    assert!(worst_angle_rad < 0.12, "{} degrees", worst_angle_rad.to_degrees());
}

#[test]
fn what_all_pictures_share_does_not_average_out() {
    const REGION_M: f32 = 4e-5;
    let mut clusterer = BallClusterer::new(Config { ball_radius_m: 1e-3, ..Config::default() }).unwrap();
    for stamp_nanos in 0..100 {
        let of_picture = |stamp_nanos| Header { phase: Phase::Shape, stamp_nanos, ..Header::default() };
        let point = scan(0, vec![point([0.0; 3])]);
        clusterer.insert(&Scan { header: of_picture(stamp_nanos), region_sigma_m: f64::from(REGION_M), ..point });
    }
    let cloud = clusterer.whole();
    let own = NOISE_M / 100f32.sqrt();
    assert!((cloud.points[0].sigma_m - own.hypot(REGION_M)).abs() < 1e-7, "{}", cloud.points[0].sigma_m);
}

#[test]
fn a_thin_sheet_keeps_both_faces() {
    let (width_m, thickness_m) = (0.01, 0.6e-3);
    let face = |i: usize| {
        let up = i.is_multiple_of(2);
        let z = if up { thickness_m } else { 0.0 };
        let to_sensor = [0.0, 0.0, if up { 1.0 } else { -1.0 }];
        ScanPoint { to_sensor, ..point([width_m * noise(i, 0), width_m * noise(i, 1), z]) }
    };
    let mut clusterer =
        BallClusterer::new(Config { ball_radius_m: 0.4e-3, least_points: 3, ..Config::default() }).unwrap();
    clusterer.insert(&scan(0, (0..60_000).map(face).collect()));
    let cloud = clusterer.whole();
    for p in cloud.points.iter() {
        let up = p.position_m[2] > 0.5 * thickness_m;
        assert!(if up { p.normal[2] > 0.99 } else { p.normal[2] < -0.99 }, "{p:?}");
    }
}

#[test]
fn few_points_have_the_sensors_direction_for_a_normal() {
    let mut clusterer =
        BallClusterer::new(Config { ball_radius_m: 1e-3, least_points: 1, ..Config::default() }).unwrap();
    clusterer.insert(&scan(0, vec![point([0.0; 3])]));
    let cloud = clusterer.whole();
    let only = cloud.points[0];
    assert_eq!((only.normal, only.spread_m, only.count), ([0.0, 0.0, 1.0], 0.0, 1));
    assert!((only.sigma_m - NOISE_M).abs() < 1e-7);
}

#[test]
fn what_is_not_finite_or_far_away_is_counted_once_and_spoils_nothing() {
    let good: Vec<ScanPoint> = (0..50).map(|i| point([1e-5 * i as f32, 0.0, 0.0])).collect();
    let bad = [
        point([f32::NAN, 0.0, 0.0]),
        point([0.0, f32::INFINITY, 0.0]),
        ScanPoint { to_sensor: [f32::NAN; 3], ..point([0.0; 3]) },
        ScanPoint { sigma_m: f32::NEG_INFINITY, ..point([0.0; 3]) },
        point([1e9, 0.0, 0.0]),
    ];
    let mut clusterer = BallClusterer::new(Config::default()).unwrap();
    clusterer.insert(&scan(0, good.iter().chain(&bad).copied().collect()));
    clusterer.insert(&Scan { region_sigma_m: f64::NAN, ..scan(0, vec![point([0.0; 3])]) });
    let refused = clusterer.changes().refused;
    let told: Vec<(&str, u64)> = refused.iter().map(|r| (r.reason.as_str(), r.count)).collect();
    assert_eq!(told, [("point not finite", 5), ("point out of range", 1)]);
    let mut clean = BallClusterer::new(Config::default()).unwrap();
    clean.insert(&scan(0, good));
    assert_eq!(clusterer.whole(), clean.whole());
}

#[test]
fn a_higher_revision_starts_afresh_and_a_lower_one_is_refused() {
    let mut clusterer = BallClusterer::new(Config { least_points: 1, ..Config::default() }).unwrap();
    clusterer.insert(&scan(0, vec![point([0.0; 3])]));
    assert_eq!(clusterer.changes().extent, Extent::Whole);
    clusterer.insert(&scan(0, vec![point([0.1; 3])]));
    let second = clusterer.changes();
    assert_eq!((second.extent, second.points.len(), second.points[0].id), (Extent::Changes, 1, 1));
    clusterer.insert(&scan(1, vec![point([0.2; 3])]));
    let fresh = clusterer.changes();
    assert_eq!((fresh.extent, fresh.header.revision, fresh.points.len()), (Extent::Whole, 1, 1));
    clusterer.insert(&scan(0, vec![point([0.3; 3])]));
    let whole = clusterer.whole();
    assert_eq!((whole.points.len(), whole.refused[0].count), (1, 1));
}

#[test]
fn nothing_in_gives_nothing_out_and_aiming_keeps_nothing() {
    let mut clusterer = BallClusterer::new(Config::default()).unwrap();
    assert!(clusterer.whole().points.is_empty());
    let mut aiming = scan(0, dome(100));
    aiming.header.phase = Phase::Aim;
    clusterer.insert(&aiming);
    assert!(clusterer.whole().points.is_empty() && clusterer.held().points == 0);
}

#[test]
fn balls_are_as_large_as_the_places_are_uncertain_and_shrink_when_a_revision_knows_better() {
    let mut clusterer = BallClusterer::new(Config::default()).unwrap();
    let dome = dome(200_000);
    clusterer.insert(&scan(0, dome.clone()));
    let exact = clusterer.whole().points.len();
    // 1 degree at 50 mm and 1 mm: D = 2 sqrt(0.87^2 + 1) mm.
    clusterer.insert(&Scan { position_sigma_m: 1e-3, rotation_sigma_rad: 1f64.to_radians(), ..scan(1, dome.clone()) });
    let vague = clusterer.whole().points.len();
    let ratio = exact as f64 / vague as f64;
    let expected = (2.0_f64 * (0.873_f64.powi(2) + 1.0).sqrt() / 0.8).powi(2);
    assert!((ratio / expected - 1.0).abs() < 0.2, "{exact} balls, then {vague}: {ratio} times fewer, not {expected}");
    clusterer.insert(&scan(2, dome));
    assert_eq!(clusterer.whole().points.len(), exact);
}

#[test]
fn the_table_that_was_taken_away_is_told_with_the_cloud() {
    // A dome on a table at the height of 20 mm, a plane of 300 mm.
    let raised = |p: ScanPoint| point([p.position_m[0], p.position_m[1], p.position_m[2] + 0.02]);
    let on_table = |i: usize| point([0.15 * noise(i, 3), 0.15 * noise(i, 4), 0.02 + NOISE_M * noise(i, 5)]);
    let beside = |p: &ScanPoint| p.position_m[0].hypot(p.position_m[1]) > RADIUS_M;
    let mut points: Vec<ScanPoint> = dome(60_000).into_iter().map(raised).collect();
    points.extend((0..120_000).map(on_table).filter(beside));
    let cloud = |table| {
        let mut clusterer = BallClusterer::new(Config { ball_radius_m: 2e-3, table, ..Config::default() }).unwrap();
        clusterer.insert(&scan(0, points.clone()));
        assert_eq!(clusterer.changes().table, None);
        clusterer.whole()
    };
    let kept = cloud(Table::Keep);
    assert_eq!(kept.table, None);
    let thing = cloud(Table::Remove);
    let table = thing.table.unwrap();
    assert!(table.normal[2] > 0.99999 && (table.distance_m - 0.02).abs() < 2e-5, "{table:?}");
    assert!(thing.points.len() < kept.points.len() && thing.points.iter().all(|ball| ball.position_m[2] > 0.02));
    let refused = thing.refused.iter().find(|refusal| refusal.reason == "ball of the table").unwrap();
    assert_eq!(refused.count as usize, kept.points.len() - thing.points.len());
}

#[test]
fn a_configuration_that_cannot_be_is_named() {
    for radius in [0.0, -1.0, f64::NAN, 1.0] {
        let config = Config { ball_radius_m: radius, ..Config::default() };
        assert!(matches!(BallClusterer::new(config).err(), Some(ConfigError::BallRadius(_))));
    }
    let config = Config { least_points: 0, ..Config::default() };
    assert_eq!(BallClusterer::new(config).err(), Some(ConfigError::LeastPoints));
}

proptest! {
    #[test]
    fn no_numbers_make_it_panic(
        points in prop::collection::vec((prop::array::uniform3(any::<f32>()), prop::array::uniform3(any::<f32>()), any::<f32>()), 0..60)
    ) {
        let points = points.into_iter().map(|(position_m, to_sensor, sigma_m)| ScanPoint { position_m, to_sensor, sigma_m, amplitude: 0.0 });
        let mut clusterer = BallClusterer::new(Config { least_points: 1, ..Config::default() }).unwrap();
        let points: Vec<ScanPoint> = points.collect();
        let count = points.len() as u64;
        clusterer.insert(&scan(0, points));
        let cloud = clusterer.whole();
        let told: u64 = cloud.refused.iter().map(|r| r.count).sum();
        prop_assert_eq!(told + cloud.points.iter().map(|p| u64::from(p.count)).sum::<u64>(), count);
        prop_assert!(cloud.points.iter().all(|p| p.position_m.iter().chain(&p.normal).all(|c| c.is_finite())));
    }
}
