//! When a line counts as half dead.

use serial_line::Noise;

const RECORD: u64 = 24;
const PERIOD_NANOS: i64 = 10_000_000;

/// Records of 24 bytes, a hundred a second, of which from the record `from` on so many of a hundred come in pieces: when it
/// is named, in records behind that, and with which share.
fn named(from: i64, percent: i64, records: i64) -> Vec<(i64, f64)> {
    let mut noise = Noise::default();
    let mut hear = |k: i64| {
        let broken = k >= from && (k * 37).rem_euclid(100) < percent;
        noise.hear(k * PERIOD_NANOS, RECORD, if broken { RECORD } else { 0 }).map(|share| (k - from, share))
    };
    (0..records).filter_map(&mut hear).collect()
}

#[test]
fn it_is_named_within_a_second_wherever_it_begins() {
    for from in 150..350 {
        for percent in [27, 40, 70, 100] {
            let told = named(from, percent, from + 200);
            assert!(matches!(told[..], [(after, share)] if after < 100 && share >= 0.25), "{from} {percent}: {told:?}");
        }
    }
}

#[test]
fn from_the_first_byte_on_as_well() {
    let told = named(0, 60, 200);
    assert!(matches!(told[..], [(after, _)] if after < 100), "{told:?}");
}

#[test]
fn a_line_that_loses_some_is_not_half_dead_and_the_same_is_told_again_after_half_a_minute() {
    assert_eq!(named(0, 20, 5000), []);
    let told: Vec<i64> = named(0, 100, 6500).into_iter().map(|(after, _)| after).collect();
    assert_eq!(told.len(), 3, "{told:?}");
    assert!(told.windows(2).all(|pair| pair[1] - pair[0] == 3000), "{told:?}");
}

#[test]
fn what_the_set_up_left_in_the_middle_of_a_record_is_no_noise() {
    let mut noise = Noise::default();
    assert_eq!(noise.hear(0, RECORD, RECORD), None);
    assert_eq!((1..200).find_map(|k| noise.hear(k * PERIOD_NANOS, RECORD, 0)), None);
}
