//! Times of the jobs in the README's table: `cargo bench -p surface --no-default-features`.

#[path = "../tests/surface/animal.rs"]
#[allow(dead_code, reason = "the tests need more of it")]
mod animal;

use animal::{on_animal, scanned};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use std::hint::black_box;
use surface::{Config, Surfer, surface_from_points};
use wire::{Cloud, CloudPoint, Extent, Header};

fn whole(c: &mut Criterion) {
    for (name, count, noise_m) in [("50000_points", 50_000, 0.05e-3), ("1000000_points_0.2_mm", 1_000_000, 0.2e-3)] {
        let (points, normals) = scanned(&on_animal(count, 1), noise_m, 5.0, 2);
        let run = || surface_from_points(black_box(&points), Some(&normals), Config::default());
        c.benchmark_group("surface").sample_size(10).bench_function(name, |b| b.iter(run));
    }
}

/// A second of a live scan: 5,000 points of one region change in a cloud of 150,000.
fn live(c: &mut Criterion) {
    let (points, normals) = scanned(&on_animal(150_000, 1), 0.1e-3, 5.0, 2);
    let point = |((&position_m, &normal), id)| CloudPoint { position_m, normal, id, ..CloudPoint::default() };
    let points: Vec<CloudPoint> = points.iter().zip(&normals).zip(0..).map(point).collect();
    let cloud = |points: Vec<CloudPoint>, extent| Cloud {
        header: Header::default(),
        extent,
        table: None,
        points: points.into(),
        refused: Vec::new(),
    };
    let mut nearest = points.clone();
    let from_flank = |p: &CloudPoint| {
        (p.position_m[0].powi(2) + (p.position_m[1] - 0.03).powi(2) + (p.position_m[2] - 0.06).powi(2)) as f64
    };
    nearest.sort_by(|a, b| from_flank(a).total_cmp(&from_flank(b)));
    nearest.truncate(5000);
    for point in &mut nearest {
        point.position_m[1] += 0.05e-3;
    }
    let change = cloud(nearest, Extent::Changes);
    let Ok(mut surfer) = Surfer::new(Config::default()) else { return };
    surfer.update(&cloud(points, Extent::Whole));
    surfer.live_mesh();
    let Ok(one_core) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else { return };
    let run = |mut surfer: Surfer| {
        one_core.install(|| {
            surfer.update(&change);
            surfer.live_mesh()
        })
    };
    c.benchmark_group("live").sample_size(10).bench_function("5000_points_one_core", |b| {
        b.iter_batched(|| surfer.clone(), run, BatchSize::PerIteration);
    });
}

criterion_group!(benches, whole, live);
criterion_main!(benches);
