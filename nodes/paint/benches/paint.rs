//! `cargo bench -p paint --no-default-features`

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry3, Point3, Vector3};
use paint::{Config, FrameStore, Painter};
use std::hint::black_box;
use wire::*;

fn header() -> Header {
    Header { phase: Phase::Colour, ..Header::default() }
}

fn calibration() -> Calibration {
    let camera = CameraIntrinsics {
        width: 1280,
        height: 1024,
        fx: 1400.0,
        fy: 1400.0,
        cx: 640.0,
        cy: 512.0,
        distortion: [-0.1, 0.05, 1e-3, -5e-4, 0.0],
    };
    let laser =
        LaserPlane { normal: [0.0, 0.0, 1.0], distance_m: 0.2, channel_weights: [1.0; 3], peaks_per: PeaksPer::Row };
    let body_from_camera = RigidPose::IDENTITY;
    Calibration { header: header(), camera, laser, body_from_camera, pose_offset_nanos: 0, name: "bench".into() }
}

/// A lumpy ball of about 150 mm, n rings of 2 n triangles' corners.
fn ball(n: u32) -> Mesh {
    let at = |ring: u32, turn: u32| {
        let (polar, around) = (
            std::f32::consts::PI * (ring as f32 + 0.5) / (n + 1) as f32,
            std::f32::consts::TAU * turn as f32 / (2 * n) as f32,
        );
        let radius = 0.065 + 0.006 * (5.0 * around).sin() * (4.0 * polar).sin();
        [radius * polar.sin() * around.cos(), radius * polar.sin() * around.sin(), radius * polar.cos()]
    };
    let vertices: Vec<[f32; 3]> = (0..=n).flat_map(|ring| (0..2 * n).map(move |turn| at(ring, turn))).collect();
    let corner = |ring: u32, turn: u32| ring * 2 * n + turn % (2 * n);
    let triangles: Vec<[u32; 3]> = (0..n)
        .flat_map(|r| (0..2 * n).map(move |t| [corner(r, t), corner(r + 1, t), corner(r + 1, t + 1), corner(r, t + 1)]))
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    Mesh {
        header: header(),
        vertices_m: vertices.into(),
        normals: vec![].into(),
        sigma_m: vec![].into(),
        measured: triangles.len() as u32,
        triangles: triangles.into(),
    }
}

fn frame(seq: u64) -> Frame {
    let (width, height) = (1280, 1024);
    let data: Vec<u8> = (0..3 * width * height).map(|i| (40 + i % 151) as u8).collect();
    Frame {
        header: Header { stamp_nanos: seq as i64, ..header() },
        width,
        height,
        stride: 3 * width,
        format: PixelFormat::Rgb8,
        light: Light { laser: false, lamp: true },
        exposure_nanos: 10_000_000,
        gain: 1.0,
        gamma: 2.2,
        data: data.into(),
    }
}

fn poses() -> Vec<Isometry3<f64>> {
    (0..16)
        .map(|i| {
            let around = f64::from(i) * 2.399;
            let eye = Point3::new(0.26 * around.cos(), 0.26 * around.sin(), 0.012 * f64::from(i) - 0.09);
            Isometry3::face_towards(&eye, &Point3::origin(), &-Vector3::z())
        })
        .collect()
}

fn atlas(c: &mut Criterion) {
    let mesh = ball(112);
    c.bench_function(&format!("atlas of {} triangles, 1 mm", mesh.triangles.len()), |b| {
        let mut painter = Painter::new(Config::default(), &calibration()).expect("good");
        b.iter(|| painter.mesh(black_box(&mesh)));
    });
}

fn frames(c: &mut Criterion) {
    let mesh = ball(224);
    for cell_mm in [1.0, 0.25] {
        let mut painter = Painter::new(Config { cell_mm, ..Config::default() }, &calibration()).expect("good");
        painter.mesh(&mesh).expect("good");
        let (poses, mut seq) = (poses(), 0);
        let name = format!("frame 1280x1024 onto {} triangles, {cell_mm} mm", mesh.triangles.len());
        c.bench_function(&name, |b| {
            b.iter_batched_ref(
                || frame(0),
                |frame| {
                    seq += 1;
                    frame.header.stamp_nanos = seq as i64;
                    painter.frame(frame, &poses[seq % poses.len()])
                },
                BatchSize::LargeInput,
            );
        });
        c.bench_function(&format!("model, {cell_mm} mm"), |b| b.iter(|| painter.model()));
    }
}

fn store(c: &mut Criterion) {
    let mut painter = Painter::new(Config::default(), &calibration()).expect("good");
    let mut store = FrameStore::new(64 << 20);
    let frame = frame(0);
    c.bench_function("crop and store 1280x1024", |b| {
        b.iter(|| painter.crop(&frame).map(|picture| store.push(picture)));
    });
}

criterion_group!(benches, atlas, frames, store);
criterion_main!(benches);
