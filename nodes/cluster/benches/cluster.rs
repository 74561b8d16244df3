//! A sweep over a 150 mm object, flat out on one core: 1000 points a stripe, 0.15 mm apart, 0.1 mm of noise.

use cluster::{BallClusterer, Config};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use wire::{Header, Phase, Scan, ScanPoint};

const POINTS_PER_SCAN: usize = 1000;

fn noise(i: usize) -> f32 {
    let h = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let h = (h ^ (h >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((h >> 40) as f32) / (1u64 << 23) as f32 - 1.0
}

/// Pass after pass over a hilly square, each scan 1.7 mm beside the last (100 mm/s at 60 pictures a second).
fn sweep(scans: usize) -> Vec<Scan> {
    const SIDE_M: f32 = 0.15;
    let scan = |s: usize| {
        let travelled = 0.0017 * s as f32;
        let x = travelled % SIDE_M + 0.0003 * noise(s);
        let point = |i: usize| {
            let y = SIDE_M * i as f32 / POINTS_PER_SCAN as f32;
            let z = 0.01 * (60.0 * x).sin() * (50.0 * y).cos() + 1e-4 * noise(s * POINTS_PER_SCAN + i);
            ScanPoint {
                position_m: [x, y + 0.0001 * noise(s), z],
                to_sensor: [0.0, 0.0, 1.0],
                sigma_m: 1e-4,
                amplitude: 90.0,
            }
        };
        Scan {
            points: (0..POINTS_PER_SCAN).map(point).collect(),
            ..Scan::none(Header { phase: Phase::Shape, stamp_nanos: s as i64, ..Header::default() })
        }
    };
    (0..scans).map(scan).collect()
}

fn insert(c: &mut Criterion) {
    let mut group = c.benchmark_group("insert");
    group.sample_size(10);
    for scans in [1000, 4000] {
        let sweep = sweep(scans);
        group.throughput(Throughput::Elements((scans * POINTS_PER_SCAN) as u64));
        group.bench_function(format!("{scans} scans"), |b| {
            let new = || BallClusterer::new(Config::default()).expect("the defaults are good");
            b.iter_batched(
                new,
                |mut clusterer| {
                    for scan in &sweep {
                        clusterer.insert(black_box(scan));
                    }
                    clusterer
                },
                BatchSize::PerIteration,
            );
        });
    }
    group.finish();
}

fn output(c: &mut Criterion) {
    let mut clusterer = BallClusterer::new(Config::default()).expect("the defaults are good");
    for scan in sweep(1000) {
        clusterer.insert(&scan);
    }
    println!("{:?}", clusterer.held());
    let balls = clusterer.whole().points.len();
    let mut group = c.benchmark_group("output");
    group.sample_size(10).throughput(Throughput::Elements(balls as u64));
    group.bench_function("whole", |b| b.iter(|| clusterer.whole()));
    group.finish();
}

criterion_group!(benches, insert, output);
criterion_main!(benches);
