//! From what the driver gives to what travels.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use camera_v4l::{
    CameraV4l, ClockReading, Config, DriverFormat, DriverStamp, Exposed, Layout, PixelError, Refused, Setting,
};
use wire::{Clock, LaserPlane, Light, PeaksPer, Phase, PixelFormat};

const SYSTEM: i64 = 1_700_000_000_000_000_000;

fn camera(config: Config) -> CameraV4l {
    let laser = LaserPlane {
        normal: [1.0, 0.0, 0.0],
        distance_m: 0.1,
        channel_weights: [1.0, 0.0, 0.0],
        peaks_per: PeaksPer::Row,
    };
    CameraV4l::new(config, laser).unwrap()
}

fn exposed(bytes: usize, flags: u32) -> Exposed {
    Exposed {
        bytes: vec![40; bytes],
        layout: Layout { format: DriverFormat::Grey, full_range: false, width: 64, height: 48, stride: 80 },
        stamp: DriverStamp { nanos: 10_000_000, flags, arrival_nanos: 12_000_000 },
        sequence: 3,
        damaged: false,
        setting: Setting { exposure_us: 4000.0, gain: 2.5 },
    }
}

const READING: [ClockReading; 1] = [ClockReading { before: 0, system: SYSTEM + 50, after: 100 }];

#[test]
fn a_frame_says_when_and_how_it_was_exposed() {
    let mut camera = camera(Config { gamma: 1.5, stamp_delay_us: 500.0, ..Config::default() });
    let frame = camera.process(exposed(80 * 48, 0x2000), &READING, Phase::Colour).unwrap();
    assert_eq!(frame.header.stamp_nanos, SYSTEM + 10_000_000 - 2_000_000 - 500_000);
    assert_eq!((frame.header.clock, frame.header.phase), (Clock::System, Phase::Colour));
    assert_eq!((frame.exposure_nanos, frame.gain, frame.gamma), (4_000_000, 2.5, 1.5));
    assert_eq!((frame.width, frame.height, frame.stride, frame.format), (64, 48, 80, PixelFormat::Grey8));
    assert_eq!(frame.light, Light { laser: false, lamp: true });
    assert_eq!(frame.check(), Ok(()));
    assert_eq!(camera.clock_uncertainty_nanos(), Some(50));
}

#[test]
fn what_is_no_frame_is_refused_and_the_next_is_taken() {
    let mut camera = camera(Config::default());
    let mut process = |exposed, readings: &[ClockReading]| camera.process(exposed, readings, Phase::Shape);
    assert_eq!(process(exposed(80 * 48, 0x2000), &[]), Err(Refused::Clock));
    assert!(matches!(process(exposed(80 * 48, 0), &READING), Err(Refused::Stamp(_))));
    let short = process(exposed(3000, 0x2000), &READING);
    assert_eq!(short, Err(Refused::Pixels(PixelError::Short { bytes: 3000, needed: 80 * 47 + 64 })));
    assert!(process(exposed(80 * 47 + 64, 0x2000), &READING).is_ok());
}
