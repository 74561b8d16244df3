//! A live tick and the final refinement at the end of a scan of a minute, 130,000 points.

#![allow(clippy::unwrap_used, reason = "a bench may stop")]

#[path = "../tests/swept/mod.rs"]
mod swept;

use criterion::{Criterion, criterion_group, criterion_main};
use refine::Config;
use std::hint::black_box;
use std::time::Duration;
use swept::{Spec, Sweep};

fn minute(c: &mut Criterion) {
    let sweep = Sweep::new(&Spec::named("W", 1));
    let mut refiner = sweep.refiner(Config::default());
    let mut group = c.benchmark_group("60 s, 130,000 points");
    group.sample_size(10).measurement_time(Duration::from_secs(10));
    group.bench_function("tick", |b| b.iter(|| black_box(refiner.tick()).unwrap().trajectory.len()));
    group.bench_function("finish", |b| b.iter(|| black_box(refiner.finish()).unwrap().trajectory.len()));
    group.finish();
}

criterion_group!(benches, minute);
criterion_main!(benches);
