//! Records a second on one core: from bytes to values.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use tracker_polhemus::protocol::decoder::Decoder;
use tracker_polhemus::protocol::records::{Family, Layout, Record, encode};

const RECORDS: u32 = 1000;

fn decode(c: &mut Criterion) {
    let mut group = c.benchmark_group("decode");
    group.throughput(Throughput::Elements(u64::from(RECORDS)));
    for family in [Family::Fastrak, Family::Liberty] {
        let layout = Layout::of(family);
        let record = |k| Record { position_inches: [k as f32 * 0.01, 2.0, 3.0], time_stamp_ms: k, ..Record::default() };
        let bytes: Vec<u8> = (0..RECORDS).flat_map(|k| encode(&record(k), &layout)).collect();
        group.bench_function(format!("{family:?}"), |b| {
            let mut decoder = Decoder::new(layout.clone());
            b.iter(|| {
                let records = black_box(&bytes).iter().filter_map(|&byte| decoder.push(byte));
                black_box(records.map(|record| f64::from(record.position_inches[0])).sum::<f64>())
            });
        });
    }
}

criterion_group!(benches, decode);
criterion_main!(benches);
