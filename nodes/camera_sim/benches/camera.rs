//! Frames of the demo's two rigs, on all cores, one lamp frame in six.

use camera_sim::CameraSim;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use geometry::Rig;
use world::{Hand, Known, Scene};

fn bench(c: &mut Criterion) {
    let mut group = c.benchmark_group("camera_sim");
    for name in ["paper", "fine"] {
        let path = format!("{}/../../config/rigs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
        let rig = Rig::parse(&text).unwrap_or_else(|e| panic!("{path}: {e}"));
        let size = format!("{name} {}x{}", rig.camera.width, rig.camera.height);
        let scene = Scene::cow().unwrap_or_else(|e| panic!("{e}"));
        let hand = Hand::new(&scene, &rig, 60.0, 1).unwrap_or_else(|e| panic!("{e}"));
        let camera = CameraSim::new(&Known { scene, rig, hand, seed: 1 }).unwrap_or_else(|e| panic!("{e}"));
        const FRAMES: u64 = 24;
        let mut first = 0;
        group.throughput(Throughput::Elements(FRAMES)).sample_size(20);
        group.bench_function(size, |b| {
            b.iter(|| {
                // All along the sweep: a frame costs what it shows.
                first = (first + 97) % (camera.frames() - FRAMES);
                camera.batch(first..first + FRAMES)
            });
        });
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
