//! The incremental clustering against the paper's pseudo code, word by word.

use cluster::{BallClusterer, Config};
use proptest::prelude::*;
use wire::{Cloud, CloudPoint, Extent, Header, Phase, Scan, ScanPoint};

const D: f32 = 1e-3;
const T: u32 = 3;

fn config() -> Config {
    Config { ball_radius_m: f64::from(D), least_points: T, ..Config::default() }
}

fn scan(points: &[[f32; 3]]) -> Scan {
    let point =
        |&position_m: &[f32; 3]| ScanPoint { position_m, to_sensor: [0.0, 0.0, 1.0], sigma_m: 1e-4, amplitude: 1.0 };
    Scan {
        points: points.iter().map(point).collect(),
        ..Scan::none(Header { phase: Phase::Shape, ..Header::default() })
    }
}

fn squared(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
}

/// A ball of the literal algorithm: the number of its centre, how many points, their average.
#[derive(Debug, Clone, PartialEq)]
struct PaperBall {
    id: usize,
    count: u32,
    average: [f64; 3],
}

/// Section 2.4, with its comments. Also how many points the outlier balls held.
fn paper(points: &[[f32; 3]]) -> (Vec<PaperBall>, u64) {
    // make initial ball center list
    let mut ball_center_list: Vec<[f32; 3]> = vec![];
    for p in points {
        if !ball_center_list.iter().any(|centre| squared(p, centre) <= D * D) {
            ball_center_list.push(*p);
        }
    }
    // assign points to balls
    let mut balls: Vec<Vec<[f32; 3]>> = vec![vec![]; ball_center_list.len()];
    for p in points {
        let distance = |i: &usize| squared(p, &ball_center_list[*i]);
        let closest =
            (0..balls.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("every point has a centre");
        balls[closest].push(*p);
    }
    // delete outlier balls
    let (kept, outliers): (Vec<_>, Vec<_>) = balls.into_iter().enumerate().partition(|(_, b)| b.len() >= T as usize);
    // form output points
    let average = |b: &[[f32; 3]]| [0, 1, 2].map(|k| b.iter().map(|p| f64::from(p[k])).sum::<f64>() / b.len() as f64);
    let output = kept.iter().map(|(id, b)| PaperBall { id: *id, count: b.len() as u32, average: average(b) });
    (output.collect(), outliers.iter().map(|(_, b)| b.len() as u64).sum())
}

fn clustered(points: &[[f32; 3]], batch: usize) -> Cloud {
    let mut clusterer = BallClusterer::new(config()).expect("a good configuration");
    for some in points.chunks(batch) {
        clusterer.insert(&scan(some));
    }
    clusterer.whole()
}

fn assert_same(points: &[[f32; 3]]) {
    let (expected, outliers) = paper(points);
    let cloud = clustered(points, 1);
    assert_eq!(cloud.extent, Extent::Whole);
    let ids = |p: &CloudPoint| (p.id as usize, p.count);
    assert_eq!(
        cloud.points.iter().map(ids).collect::<Vec<_>>(),
        expected.iter().map(|b| (b.id, b.count)).collect::<Vec<_>>()
    );
    for (point, ball) in cloud.points.iter().zip(&expected) {
        for axis in 0..3 {
            // 12 nm of counting, and the rounding of an f32 as far from the origin as these are.
            let tolerance = 2.5e-8 + 1.2e-7 * ball.average[axis].abs();
            assert!((f64::from(point.position_m[axis]) - ball.average[axis]).abs() < tolerance);
        }
    }
    assert_eq!(cloud.refused.iter().map(|r| r.count).sum::<u64>(), outliers);
}

/// Points in a volume, on a noisy sheet, or on a lattice (where many distances are equal).
fn points() -> impl Strategy<Value = Vec<[f32; 3]>> {
    let volume = prop::collection::vec(prop::array::uniform3(-3.0 * D..3.0 * D), 0..400);
    let sheet = prop::collection::vec((-6.0 * D..6.0 * D, -6.0 * D..6.0 * D, -0.3 * D..0.3 * D), 0..600);
    let sheet = sheet.prop_map(|points| points.into_iter().map(|(x, y, z)| [0.3 + x, y, z + 0.5 * x]).collect());
    let lattice = prop::collection::vec(prop::array::uniform3(-6i8..6), 0..400);
    let lattice = lattice.prop_map(|points| points.iter().map(|p| p.map(|c| f32::from(c) * 0.5 * D)).collect());
    prop_oneof![volume, sheet, lattice]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn it_is_the_algorithm_of_the_paper(points in points()) {
        assert_same(&points);
    }

    #[test]
    fn batches_and_questions_in_between_leave_no_trace(points in points(), batch in 1usize..50, ask in 1usize..9) {
        let mut asked = BallClusterer::new(config()).expect("a good configuration");
        for (i, some) in points.chunks(batch).enumerate() {
            asked.insert(&scan(some));
            if i % ask == 0 {
                asked.changes();
            }
        }
        prop_assert_eq!(asked.whole(), clustered(&points, points.len().max(1)));
    }

    #[test]
    fn the_changes_add_up_to_the_whole(points in points(), batch in 1usize..80) {
        let mut clusterer = BallClusterer::new(config()).expect("a good configuration");
        let mut kept = std::collections::BTreeMap::new();
        for some in points.chunks(batch) {
            clusterer.insert(&scan(some));
            kept.extend(clusterer.changes().points.iter().map(|p| (p.id, *p)));
        }
        let whole = clusterer.whole();
        for point in whole.points.iter() {
            let known = kept.get(&point.id).expect("a ball that is good at the end was told of");
            prop_assert_eq!((known.position_m, known.count, known.sigma_m > 0.0), (point.position_m, point.count, true));
        }
        let fallen = |p: &&CloudPoint| p.count == 0;
        let good: Vec<u32> = kept.values().filter(|p| !fallen(p)).map(|p| p.id).collect();
        prop_assert_eq!(good, whole.points.iter().map(|p| p.id).collect::<Vec<_>>());
    }
}
