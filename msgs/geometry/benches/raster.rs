//! 200,000 triangles of a sphere into 1280x1024.

use criterion::{Criterion, criterion_group, criterion_main};
use geometry::{Camera, TriangleMesh, VisibilityBuffer};
use nalgebra::{Isometry3, Point3, Translation3};
use std::hint::black_box;

fn sphere(rings: u32, radius_m: f32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let around = 2 * rings;
    for i in 0..=rings {
        let (sin, cos) = (std::f32::consts::PI * i as f32 / rings as f32).sin_cos();
        for j in 0..around {
            let (y, x) = (std::f32::consts::TAU * j as f32 / around as f32).sin_cos();
            mesh.vertices.push(Point3::new(radius_m * sin * x, radius_m * sin * y, radius_m * cos));
        }
    }
    for i in 0..rings {
        for j in 0..around {
            let next = (j + 1) % around;
            let [a, b, c, d] = [i * around + j, (i + 1) * around + j, (i + 1) * around + next, i * around + next];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

fn bench(c: &mut Criterion) {
    let distortion = [-0.1, 0.05, 1e-4, -1e-4, 0.0];
    let camera = Camera { width: 1280, height: 1024, fx: 1500.0, fy: 1500.0, cx: 639.5, cy: 511.5, distortion };
    let mesh = sphere(224, 0.07);
    let ahead = Isometry3::from_parts(Translation3::new(0.0, 0.0, 0.25), nalgebra::UnitQuaternion::identity());
    let mut seen = VisibilityBuffer::new(1280, 1024);
    for (name, cull) in [("both faces", false), ("front faces", true)] {
        seen.cull_back_faces = cull;
        c.bench_function(&format!("raster/200k triangles 1280x1024, {name}"), |b| {
            b.iter(|| {
                seen.clear();
                seen.draw(&camera, &ahead, black_box(&mesh), 0);
            });
        });
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
