//! Records a second on one core: from bytes to poses with stamps.

#![allow(clippy::unwrap_used, reason = "a bench may stop")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::{UnitQuaternion, Vector3};
use std::hint::black_box;
use tracker_flock::protocol::decoder::Decoder;
use tracker_flock::protocol::reading::{QuaternionSense, Reading, Scale, words_of};
use tracker_flock::protocol::records::{Format, Layout, encode};

const RECORDS: usize = 1000;

fn decode(c: &mut Criterion) {
    let mut group = c.benchmark_group("decode");
    group.throughput(Throughput::Elements(RECORDS as u64));
    for format in [Format::PositionAngles, Format::PositionMatrix, Format::PositionQuaternion] {
        let layout = Layout::plain(format);
        let bytes: Vec<u8> = (0..RECORDS)
            .flat_map(|k| {
                let turn = UnitQuaternion::from_euler_angles(k as f64 * 1e-3, 0.2, 0.3);
                let sense = QuaternionSense::AsMatrix;
                encode(&words_of(format, Scale::Inches36, sense, &Vector3::new(0.1, 0.2, 0.3), &turn), &layout)
            })
            .collect();
        group.bench_function(format!("{format:?}"), |b| {
            let mut decoder = Decoder::new(layout);
            b.iter(|| {
                let records = black_box(&bytes).iter().filter_map(|&byte| decoder.push(byte));
                let read = |record| Reading::of(&record, Scale::Inches36, QuaternionSense::AsMatrix).unwrap();
                let sum = records.map(read).filter_map(|reading| reading.rotation).map(|q| q.w).sum::<f64>();
                black_box(sum)
            });
        });
    }
}

criterion_group!(benches, decode);
criterion_main!(benches);
