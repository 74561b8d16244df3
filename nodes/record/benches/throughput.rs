//! How many pictures a second can be kept, by effort of compression: a camera gives 60.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use record::{Config, Recorder};
use std::collections::BTreeMap;

const WIDTH: usize = 1280;
const HEIGHT: usize = 1024;

/// A dark picture with 2 grey levels of noise (xorshift), as a camera gives it.
fn noisy_picture() -> Vec<u8> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    // The sum of four bytes is nearly Gaussian, with a standard deviation of 148.
    let mut noise = || {
        let word = next();
        (0..4).map(|i| (word >> (8 * i) & 0xff) as f32).sum::<f32>() / 74.0
    };
    (0..3 * WIDTH * HEIGHT).map(|i| ((i / 3 % WIDTH) as f32 / 16.0 + noise()) as u8).collect()
}

fn pictures(c: &mut Criterion) {
    let picture = noisy_picture();
    let mut group = c.benchmark_group("record 1280x1024 RGB");
    group.throughput(Throughput::Elements(1)).sample_size(10);
    for zstd_level in [0, 1, 3] {
        group.bench_function(format!("zstd level {zstd_level}"), |b| {
            b.iter_custom(|pictures| {
                let folder = tempfile::tempdir().expect("a folder");
                let path = folder.path().join("bench.mcap");
                let config = Config { zstd_level, ..Config::default() };
                let start = std::time::Instant::now();
                let mut recorder = Recorder::create(&path, config, &BTreeMap::new()).expect("a file");
                for i in 0..pictures {
                    let stamp_nanos = i as i64 * 16_666_667;
                    recorder.write("camera/head/frame", "Frame@1:0", stamp_nanos, &picture).expect("room on the disk");
                }
                let kept = recorder.finish().expect("room on the disk");
                let took = start.elapsed();
                let size = std::fs::metadata(&path).expect("the file").len();
                println!("level {zstd_level}: {pictures} pictures, packed to {:.3}", size as f64 / kept.bytes as f64);
                took
            });
        });
    }
    group.finish();
}

criterion_group!(benches, pictures);
criterion_main!(benches);
