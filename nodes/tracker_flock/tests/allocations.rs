//! From bytes to a pose with its stamp: nothing is allocated for a record.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use allocation_counter::measure;
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::PoseTracker as _;
use tracker_flock::protocol::decoder::Decoder;
use tracker_flock::protocol::reading::{QuaternionSense, Scale, words_of};
use tracker_flock::protocol::records::{Format, Layout, Record, encode};
use tracker_flock::{Config, FlockTracker, Heard};
use wire::Quality;

const PERIOD_NANOS: i64 = 10_000_000;

#[test]
fn no_record_allocates() {
    for output in [Format::PositionAngles, Format::PositionMatrix, Format::PositionQuaternion] {
        let layout = Layout { group: true, ..Layout::plain(output) };
        let sense = QuaternionSense::AsMatrix;
        let turn = UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3);
        let words = words_of(output, Scale::Inches36, sense, &Vector3::new(0.1, 0.2, 0.3), &turn);
        let mut bytes = Vec::new();
        for address in [1, 2] {
            bytes.extend(encode(&Record { address, ..words }, &layout));
        }
        let mut tracker =
            FlockTracker::new(Config { output, rate_hz: 100.0, sensors: vec![1, 2], ..Config::default() }).unwrap();
        let (mut decoder, mut now) = (Decoder::new(layout), 0);
        let mut round = || {
            now += PERIOD_NANOS;
            let records = bytes.iter().filter_map(|&byte| decoder.push(byte));
            let poses = records.filter_map(|record| tracker.process(&Heard { record, layout, sense }, now, 0));
            poses.filter(|pose| pose.pose.quality == Quality::Good).count()
        };
        // Until the clock is settled, each pose says so in words.
        (0..400).for_each(|_| assert!(round() <= 2));
        let mut good = 0;
        let allocated = measure(|| good = (0..1000).map(|_| round()).sum());
        assert_eq!((good, allocated.count_total), (2000, 0), "{output:?}: {allocated:?}");
    }
}
