//! A picture of 1280x1024 on its way from the driver's bytes to a frame, one core.

#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails where it unwraps")]

use camera_v4l::{CameraV4l, ClockReading, Config, DriverFormat, DriverStamp, Exposed, Layout, Setting};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use image::ImageEncoder as _;
use wire::{LaserPlane, PeaksPer, Phase};

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 1024;

fn exposed(format: DriverFormat) -> Exposed {
    let stride = format.least_stride(WIDTH).unwrap_or_default();
    let mut bytes: Vec<u8> = (0..stride * HEIGHT as usize).map(|k| (k % 97) as u8).collect();
    if format == DriverFormat::Mjpg {
        let pixels: Vec<u8> = (0..WIDTH * HEIGHT * 3).map(|k| (k / 3 % WIDTH / 8) as u8).collect();
        image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, 85)
            .write_image(&pixels, WIDTH, HEIGHT, image::ExtendedColorType::Rgb8)
            .unwrap();
    }
    Exposed {
        bytes,
        layout: Layout { format, full_range: false, width: WIDTH, height: HEIGHT, stride: stride as u32 },
        stamp: DriverStamp { nanos: 0, flags: 0x2000, arrival_nanos: 0 },
        sequence: 0,
        damaged: false,
        setting: Setting { exposure_us: 1000.0, gain: 1.0 },
    }
}

fn bench(c: &mut Criterion) {
    let laser = LaserPlane {
        normal: [1.0, 0.0, 0.0],
        distance_m: 0.1,
        channel_weights: [1.0, -0.5, -0.5],
        peaks_per: PeaksPer::Row,
    };
    let reading = [ClockReading { before: 0, system: 0, after: 100 }];
    for format in DriverFormat::ALL {
        let (mut camera, exposed) = (CameraV4l::new(Config::default(), laser).unwrap(), exposed(format));
        c.bench_function(&format!("1280x1024 {format}"), |b| {
            b.iter_batched(
                || exposed.clone(),
                |exposed| camera.process(exposed, &reading, Phase::Both).unwrap(),
                BatchSize::LargeInput,
            );
        });
    }
}

criterion_group!(benches, bench);
criterion_main!(benches);
