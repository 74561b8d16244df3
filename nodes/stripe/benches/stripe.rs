//! Frames a second on one core.

#![allow(clippy::unwrap_used, reason = "a bench may stop")]

#[path = "../tests/picture/mod.rs"]
mod picture;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use picture::{Scene, frame, red_laser, rgb};
use std::hint::black_box;
use stripe::{Config, StripeDetector};
use wire::{Frame, PeaksPer, PixelFormat};

/// Several pictures in turn, so that none stays in the first caches: 8 of 4 MB.
const FRAMES: u64 = 8;

fn frames_per_second(c: &mut Criterion) {
    let mut group = c.benchmark_group("stripe 1280x1024");
    group.throughput(Throughput::Elements(1));
    for peaks_per in [PeaksPer::Row, PeaksPer::Column] {
        let (width, height) = if peaks_per == PeaksPer::Row { (1280, 1024) } else { (1024, 1280) };
        let coloured: Vec<Frame> = (0..FRAMES)
            .map(|seed| rgb(&Scene { width, height, speckle_contrast: 0.1, seed, ..Scene::default() }, peaks_per))
            .collect();
        let grey: Vec<Frame> = coloured.iter().map(red_of).collect();
        let yuyv: Vec<Frame> = grey.iter().map(yuyv_of).collect();
        for (name, frames) in [("rgb8", &coloured), ("grey8", &grey), ("yuyv", &yuyv)] {
            let mut detector = StripeDetector::new(Config::default(), &red_laser(peaks_per)).unwrap();
            let mut turn = frames.iter().cycle();
            group.bench_function(format!("{name} {peaks_per:?}"), |b| {
                b.iter(|| black_box(detector.process(turn.next().unwrap()).unwrap()));
            });
        }
    }
}

fn red_of(coloured: &Frame) -> Frame {
    let red = coloured.data.iter().step_by(3).copied().collect();
    frame(coloured.width as usize, coloured.height as usize, PixelFormat::Grey8, red)
}

/// The red light as brightness, over the colour of a red that is half as strong.
fn yuyv_of(red: &Frame) -> Frame {
    let pairs = red.data.chunks_exact(2).flat_map(|pair| [pair[0], 110, pair[1], 184]).collect();
    frame(red.width as usize, red.height as usize, PixelFormat::Yuyv, pairs)
}

criterion_group!(benches, frames_per_second);
criterion_main!(benches);
