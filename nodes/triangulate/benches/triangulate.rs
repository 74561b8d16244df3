//! Points a second of triangulation, one core.

#![allow(clippy::unwrap_used, reason = "a bench may stop")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use triangulate::{Config, Triangulator};
use wire::*;

const PEAKS: u32 = 1024;

fn bench(c: &mut Criterion) {
    let distortion = [-0.084, 0.052, -0.0003, 0.0005, 0.0];
    let camera =
        CameraIntrinsics { width: 1280, height: 1024, fx: 1806.2, fy: 1805.3, cx: 634.8, cy: 517.4, distortion };
    let laser = LaserPlane {
        normal: [-0.887, -0.007, 0.461],
        distance_m: 0.0923,
        channel_weights: [1.0, 0.0, 0.0],
        peaks_per: PeaksPer::Row,
    };
    let header = Header::default();
    let calibration = Calibration {
        header,
        camera,
        laser,
        body_from_camera: RigidPose::IDENTITY,
        pose_offset_nanos: 0,
        name: String::new(),
    };
    let peak = |v: u32| StripePeak {
        u_px: 640.0 + 100.0 * (v as f32 * 0.01).sin(),
        v_px: v as f32,
        sigma_px: 0.1,
        amplitude: 90.0,
        width_px: 1.4,
        flags: StripePeak::BEST,
    };
    let light = Light { laser: true, lamp: false };
    let stripe =
        Stripe { header, width: 1280, height: 1024, light, peaks: (0..PEAKS).map(peak).collect(), refused: vec![] };
    let mut triangulator = Triangulator::new(Config::default(), &calibration).unwrap();
    let mut group = c.benchmark_group("triangulate");
    group.throughput(Throughput::Elements(u64::from(PEAKS)));
    group.bench_function("stripe of 1024 peaks", |b| b.iter(|| black_box(triangulator.process(black_box(&stripe)))));
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
