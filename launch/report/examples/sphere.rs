//! A page about a ball, to look at: `cargo run -p report --example sphere -- OUT.html`.

use formats::mesh::LoadedMesh;
use geometry::{MeshIndex, TriangleMesh, compare, truth_samples};
use nalgebra::{Isometry3, Point3, Vector3};
use report::{ColourError, Counts, Exhibits, Gate, Machine, Refused, Report, Run, Stage, Time, seen_mask};
use std::f32::consts::PI;

const RADIUS_M: f32 = 0.05;
const SEED: u64 = 1;

/// A ball whose radius is off by `error_m` (longitude, latitude), coloured in patches.
fn ball(cells: u32, lowest: f32, error_m: impl Fn(f32, f32) -> f32) -> LoadedMesh {
    let mut mesh = TriangleMesh::default();
    for j in 0..=cells {
        for i in 0..=cells {
            let longitude = 2.0 * PI * i as f32 / cells as f32;
            let latitude = lowest + (0.5 * PI - lowest) * j as f32 / cells as f32;
            let r = RADIUS_M + error_m(longitude, latitude);
            let (ring, z) = (r * latitude.cos(), r * latitude.sin());
            mesh.vertices.push(Point3::new(ring * longitude.cos(), ring * longitude.sin(), z + RADIUS_M));
            let patch = (3.0 * longitude).sin() * (5.0 * latitude).sin();
            mesh.colours.push(if patch > 0.15 { [178, 58, 46] } else { [232, 222, 200] });
        }
    }
    for j in 0..cells {
        for i in 0..cells {
            let a = j * (cells + 1) + i;
            let (b, c, d) = (a + 1, a + cells + 2, a + cells + 1);
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    LoadedMesh { mesh, texture: None }
}

fn stage(node: &str, messages: u64, busy_s: f64, latency_ms: f64) -> Stage {
    Stage {
        node: node.to_owned(),
        received: messages,
        published: messages,
        rate_hz: Some(messages as f64 / 60.0),
        busy_s,
        cpu_s: 1.1 * busy_s,
        latency_p50_ms: Some(latency_ms),
        latency_p99_ms: Some(3.1 * latency_ms),
        lost: 0,
        refused: vec![],
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = std::env::args().nth(1).ok_or("say where to write the page")?;
    let truth = ball(240, -0.5 * PI, |_, _| 0.0);
    let model =
        ball(200, -0.9, |x, y| 1e-4 * ((7.0 * x).sin() * (6.0 * y).cos() + 0.7 * (23.0 * x).sin() * (19.0 * y).sin()));
    let samples = truth_samples(&truth.mesh, SEED)?;
    let camera = geometry::Camera {
        width: 1280,
        height: 1024,
        fx: 1500.0,
        fy: 1500.0,
        cx: 639.5,
        cy: 511.5,
        distortion: [0.0; 5],
    };
    let above = |turn: f64| {
        let eye = Point3::new(0.2 * turn.cos(), 0.2 * turn.sin(), 0.15);
        Isometry3::face_towards(&eye, &Point3::new(0.0, 0.0, 0.05), &Vector3::z())
    };
    let way: Vec<Isometry3<f64>> = (0..200).map(|i| above(f64::from(i) * 0.0314)).collect();
    let seen = seen_mask(&samples, &MeshIndex::new(&truth.mesh)?, &way, &camera, &Gate::default());
    let mut triangulate = stage("triangulate/head", 3600, 1.9, 4.1);
    triangulate.refused = vec![Refused { reason: "nearer than the gate".into(), count: 1204 }];
    let mut register = stage("register/head", 3600, 2.2, 14.6);
    register.refused = vec![Refused { reason: "inside a gap of the tracker".into(), count: 12 }];
    let report = Report {
        title: "A ball, scanned".into(),
        run: Run {
            object: "a ball of 100 mm, coloured in patches".into(),
            scene: "config/scenes/ball.toml".into(),
            rig: "config/rigs/fine.toml".into(),
            seed: Some(SEED),
            pace: "fast".into(),
            sweep_s: Some(60.0),
            command: "limn demo --headless --seed 1".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            date: String::new(),
        },
        machine: Machine::here(),
        counts: Counts {
            frames: 3600,
            poses: 6000,
            points: 2_345_678,
            cloud_points: 54_321,
            triangles: 80_000,
            texture_cells: 28_412,
            area_mm2: 31_415.9,
        },
        times: vec![
            Time { what: "scanning".into(), seconds: 61.2 },
            Time { what: "surface, final".into(), seconds: 2.41 },
        ],
        stages: vec![
            stage("stripe/head", 3600, 3.6, 2.2),
            triangulate,
            register,
            stage("cluster/all", 3600, 0.6, 15.1),
        ],
        comparison: Some(compare(&model.mesh, &truth.mesh, Some(&seen), SEED)?),
        colour: Some(ColourError {
            cells: 28_412,
            gain: [1.21, 1.19, 1.32],
            rms_255: 5.4,
            channel_rms_255: [5.1, 4.9, 6.2],
            p95_255: 11.8,
        }),
        failures: vec![],
        ..Report::default()
    };
    report.write_html(out.as_ref(), &Exhibits { model: Some(&model), truth: Some(&truth), ..Exhibits::default() })?;
    Ok(())
}
