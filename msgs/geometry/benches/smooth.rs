//! Smoothing a minute and ten minutes of readings at 100 Hz, and each pose while they come.

#![allow(clippy::unwrap_used, reason = "a bench may stop")]

#[path = "../tests/hand/mod.rs"]
mod hand;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use geometry::{FixedLagSmoother, SmoothTrajectory, Smoothing, Wait};
use hand::{Hand, MS, Tracker};
use std::hint::black_box;

fn whole_scan(c: &mut Criterion) {
    let mut group = c.benchmark_group("fit");
    group.sample_size(10);
    for seconds in [60, 600] {
        let readings = Tracker::PAPER.readings(&Hand::USUAL, seconds, 1);
        group.throughput(Throughput::Elements(readings.len() as u64));
        group.bench_with_input(BenchmarkId::new("seconds", seconds), &readings, |b, readings| {
            b.iter(|| SmoothTrajectory::fit(black_box(readings), &Smoothing::default()).unwrap());
        });
    }
    group.finish();
    let way = SmoothTrajectory::fit(&Tracker::PAPER.readings(&Hand::USUAL, 60, 1), &Smoothing::default()).unwrap();
    let mut stamp = 0;
    c.bench_function("pose on a fitted way", |b| {
        b.iter(|| {
            stamp = (stamp + 16_666_667) % (59_000 * MS);
            black_box(way.at(stamp))
        });
    });
}

fn live(c: &mut Criterion) {
    let readings = Tracker::PAPER.readings(&Hand::USUAL, 20, 1);
    c.bench_function("take a reading, tuning included", |b| {
        let mut smoother = FixedLagSmoother::new(Smoothing::default()).unwrap();
        let mut i = 0;
        b.iter(|| {
            let round = (i / readings.len()) as i64 * 20_000 * MS;
            let mut reading = readings[i % readings.len()];
            reading.stamp_nanos += round;
            i += 1;
            assert!(smoother.push(&reading, 0));
        });
    });
    let mut smoother = FixedLagSmoother::new(Smoothing::default()).unwrap();
    readings.iter().for_each(|reading| {
        smoother.push(reading, 0);
    });
    for (name, wait) in [
        ("pose at the newest edge", Wait { lag_nanos: 0, predict_nanos: 10 * MS }),
        ("pose 0.3 s behind", Wait { lag_nanos: 300 * MS, predict_nanos: 0 }),
    ] {
        let mut stamp = 0;
        c.bench_function(name, |b| {
            b.iter(|| {
                stamp = (stamp + 16_666_667) % (15_000 * MS);
                black_box(smoother.at(3_000 * MS + stamp, &wait))
            });
        });
    }
}

criterion_group!(benches, whole_scan, live);
criterion_main!(benches);
