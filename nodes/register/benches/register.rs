//! Points a second of registration, one core.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use register::{Config, Register};
use std::hint::black_box;
use wire::*;

const POINTS: u32 = 1000;

fn bench(c: &mut Criterion) {
    let camera =
        CameraIntrinsics { width: 640, height: 480, fx: 800.0, fy: 800.0, cx: 320.0, cy: 240.0, distortion: [0.0; 5] };
    let laser =
        LaserPlane { normal: [-0.8, 0.0, 0.6], distance_m: 0.1, channel_weights: [1.0; 3], peaks_per: PeaksPer::Row };
    let calibration = Calibration {
        header: Header::default(),
        camera,
        laser,
        body_from_camera: RigidPose::IDENTITY,
        pose_offset_nanos: 0,
        name: String::new(),
    };
    let header = |stamp_nanos| Header { stamp_nanos, phase: Phase::Shape, ..Header::default() };
    let pose = |stamp| Pose {
        header: header(stamp),
        world_from_body: RigidPose::IDENTITY,
        position_sigma_m: [1e-3; 3],
        rotation_sigma_rad: [1e-2; 3],
        rotation_lag_nanos: 0,
        quality: Quality::Good,
        reason: String::new(),
    };
    let point = |i: u32| ProfilePoint {
        position_m: [0.0001 * i as f32, -0.02, 0.2],
        range_sigma_m: 1e-4,
        ..Default::default()
    };
    let points: Bulk<ProfilePoint> = (0..POINTS).map(point).collect();
    let mut register = Register::new(Config::default(), &calibration).unwrap();
    let mut stamp = 0;
    let mut group = c.benchmark_group("register");
    group.throughput(Throughput::Elements(u64::from(POINTS)));
    group.bench_function("profile of 1000 points", |b| {
        b.iter(|| {
            stamp += 10_000_000;
            register.pose(&pose(stamp));
            register.profile(Profile { header: header(stamp - 4_000_000), points: points.clone(), refused: vec![] });
            black_box(register.drain().count());
            black_box(register.trajectory());
        });
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
