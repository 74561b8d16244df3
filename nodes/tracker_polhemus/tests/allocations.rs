//! From bytes to a pose with its stamp: nothing is allocated for a record.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use allocation_counter::measure;
use serial_line::PoseTracker as _;
use tracker_polhemus::protocol::decoder::Decoder;
use tracker_polhemus::protocol::records::{Family, Layout, Record, encode};
use tracker_polhemus::{Config, PolhemusTracker};
use wire::Quality;

#[test]
fn no_record_allocates() {
    for (family, period_ms) in [(Family::Fastrak, 8), (Family::Liberty, 4), (Family::Patriot, 16)] {
        let layout = Layout::of(family);
        let rate_hz = Some(1000.0 / f64::from(period_ms));
        let mut tracker = PolhemusTracker::new(Config { family, rate_hz, ..Config::default() }).unwrap();
        let record = |time_stamp_ms| Record { position_inches: [12.0, -6.0, 3.0], time_stamp_ms, ..Record::default() };
        let sent: Vec<Vec<u8>> = (1..=1500).map(|k| encode(&record(k * period_ms), &layout)).collect();
        let (mut decoder, mut now) = (Decoder::new(layout), 0);
        let mut hear = |bytes: &[u8]| {
            now += i64::from(period_ms) * 1_000_000;
            let records = bytes.iter().filter_map(|&byte| decoder.push(byte));
            let poses = records.filter_map(|record| tracker.process(&record, now, 0));
            poses.filter(|pose| pose.pose.quality == Quality::Good).count()
        };
        // Until the clock is settled, each pose says so in words.
        sent[..500].iter().for_each(|bytes| assert!(hear(bytes) <= 1));
        let mut good = 0;
        let allocated = measure(|| good = sent[500..].iter().map(|bytes| hear(bytes)).sum());
        assert_eq!((good, allocated.count_total), (1000, 0), "{family:?}: {allocated:?}");
    }
}
