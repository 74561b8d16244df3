//! From the driver's memory to the bus a picture is copied once: no memory of its size is asked for behind that.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use allocation_counter::measure;
use camera_v4l::{CameraV4l, ClockReading, Config, DriverFormat, DriverStamp, Exposed, Layout, Setting};
use wire::{LaserPlane, PeaksPer, Phase, codec};

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 1024;
/// Rows of levels, the frame's head: what is asked for beside the pixels.
const SMALL_BYTES: u64 = 64 * 1024;

#[test]
fn a_picture_is_copied_once_on_its_way_to_the_bus() {
    let laser = LaserPlane {
        normal: [1.0, 0.0, 0.0],
        distance_m: 0.1,
        channel_weights: [1.0, -0.5, -0.5],
        peaks_per: PeaksPer::Row,
    };
    let mut camera = CameraV4l::new(Config::default(), laser).unwrap();
    for format in [DriverFormat::Grey, DriverFormat::Yuyv, DriverFormat::Rgb3, DriverFormat::Bgr3] {
        let stride = format.least_stride(WIDTH).unwrap() as u32;
        let driver: Vec<u8> = (0..stride * HEIGHT).map(|k| (k % 251) as u8).collect();
        let exposed = Exposed {
            bytes: &driver[..],
            layout: Layout { format, full_range: false, width: WIDTH, height: HEIGHT, stride },
            stamp: DriverStamp { nanos: 10_000_000, flags: 0x2000, arrival_nanos: 12_000_000 },
            sequence: 1,
            damaged: false,
            setting: Setting { exposure_us: 1000.0, gain: 1.0 },
        };
        let (mut held, mut sent) = (None, None);
        let copy = measure(|| held = Some(exposed.copied()));
        assert_eq!((copy.count_total, copy.bytes_total), (1, driver.len() as u64), "{format}: the one copy");
        let held = held.unwrap();
        let memory = held.bytes.as_ptr();
        let readings = [ClockReading { before: 0, system: 1_700_000_000_000_000_000, after: 100 }];
        let behind =
            measure(|| sent = Some(codec::encode_apart(camera.process(held, &readings, Phase::Shape).unwrap())));
        assert!(behind.bytes_total < SMALL_BYTES, "{format}: {behind:?}");
        // What goes to the bus lies where it was copied to.
        let (_head, pixels) = sent.unwrap();
        assert_eq!((pixels.as_ptr(), pixels.len()), (memory, driver.len()), "{format}");
    }
}
