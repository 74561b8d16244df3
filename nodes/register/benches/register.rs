//! Points a second on one core, from peaks in the picture to points in the world: triangulate and register together.

#![allow(clippy::unwrap_used, reason = "a bench may stop")]

#[path = "../tests/handset/mod.rs"]
mod handset;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use handset::{FRAME_NANOS, POSE_NANOS, calibration, pose};
use register::{Config, Register};
use std::hint::black_box;
use triangulate::Triangulator;
use wire::{Bulk, StripePeak};

/// One in each row of a 1024-row picture, as the fine rig has it.
const PEAKS: u64 = 1024;

fn points_per_second(c: &mut Criterion) {
    let calibration = calibration();
    let mut triangulator = Triangulator::new(triangulate::Config::default(), &calibration).unwrap();
    let mut register = Register::new(Config::default(), &calibration).unwrap();
    let mut stripe = handset::stripe(0, &|p| p.z, 0.1, || 0.0);
    let peaks: Vec<StripePeak> = stripe.peaks.iter().copied().cycle().take(PEAKS as usize).collect();
    stripe.peaks = Bulk(peaks);
    let mut stamp = 0;
    let mut group = c.benchmark_group("triangulate and register");
    group.throughput(Throughput::Elements(PEAKS));
    group.bench_function("stripe of 1024 peaks", |b| {
        b.iter(|| {
            for k in 0..4 {
                register.pose(&pose(stamp + k * POSE_NANOS));
            }
            stripe.header.stamp_nanos = stamp + 5_000_000;
            register.profile(triangulator.process(&stripe));
            let points = register.drain().map(|scan| black_box(scan).points.len()).sum::<usize>();
            assert_eq!(points, PEAKS as usize);
            black_box(register.trajectory());
            stamp += FRAME_NANOS;
        });
    });
}

criterion_group!(benches, points_per_second);
criterion_main!(benches);
