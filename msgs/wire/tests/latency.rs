//! Percentiles of latencies, against those of the numbers themselves.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use proptest::prelude::*;
use wire::Latencies;

/// By nearest rank: the smallest that so many do not exceed.
fn exact(sorted: &[i64], share: f64) -> i64 {
    sorted[((sorted.len() as f64 * share).ceil() as usize).clamp(1, sorted.len()) - 1]
}

fn counted(nanos: &[i64]) -> Latencies {
    let mut latencies = Latencies::default();
    nanos.iter().for_each(|nanos| latencies.note(*nanos));
    latencies
}

/// Within the width of a bin: a thirty-second, and a microsecond where they are short.
fn close(told: i64, nanos: i64) -> bool {
    (told - nanos).abs() as f64 <= nanos as f64 / 32.0 + 1000.0
}

#[test]
fn one_slow_result_in_a_hundred_is_the_99th_percentile_of_no_second_but_of_the_scan() {
    // A second of 25 pictures has no 99th of a hundred; a minute has: 60 of its 1500 took 50 ms, in 60 of 60 seconds.
    let minute: Vec<i64> = (0..1500).map(|i| if i % 25 == 7 { 50_000_000 } else { 12_000_000 }).collect();
    let told = counted(&minute);
    assert!(close(told.percentile(0.5).unwrap(), 12_000_000));
    assert!(close(told.percentile(0.99).unwrap(), 50_000_000));
    assert!(close(told.percentile(0.95).unwrap(), 12_000_000));
}

#[test]
fn the_slowest_of_a_few_is_their_99th_percentile() {
    let told = counted(&[10_000_000; 24].into_iter().chain([80_000_000]).collect::<Vec<_>>());
    assert!(close(told.percentile(0.99).unwrap(), 80_000_000));
    assert!(close(counted(&[3_000_000]).percentile(0.0).unwrap(), 3_000_000));
}

#[test]
fn an_exponential_distribution_has_its_known_percentiles() {
    let mean = 7e6_f64;
    let nanos: Vec<i64> = (0..20_000).map(|i| (-mean * (1.0 - (f64::from(i) + 0.5) / 20_000.0).ln()) as i64).collect();
    let told = counted(&nanos);
    for share in [0.1_f64, 0.5, 0.9, 0.99, 0.999] {
        let truth = -mean * (1.0 - share).ln();
        let percentile = told.percentile(share).unwrap() as f64;
        assert!((percentile / truth - 1.0).abs() < 0.01, "{share}: {percentile} instead of {truth}");
    }
}

#[test]
fn nothing_has_no_percentile_and_odd_ones_are_counted() {
    assert_eq!(Latencies::default().percentile(0.5), None);
    let odd = counted(&[i64::MIN, -1, 0, i64::MAX]);
    assert_eq!((odd.count(), odd.bins.len()), (4, 736));
    assert!(odd.percentile(0.75).unwrap() < 1000);
    assert!(close(odd.percentile(1.0).unwrap(), (1 << 27) * 1000));
}

proptest! {
    #[test]
    fn percentiles_are_right_to_within_a_bin(
        mut nanos in prop::collection::vec((0u32..36).prop_flat_map(|octave| 0..2i64 << octave), 1..300),
        share in 0.0..1.0,
    ) {
        let told = counted(&nanos).percentile(share).unwrap();
        nanos.sort_unstable();
        let truth = exact(&nanos, share);
        prop_assert!(close(told, truth), "{told} instead of {truth}");
    }

    #[test]
    fn two_lives_count_as_one(first in prop::collection::vec(0..i64::MAX, 0..50), second in prop::collection::vec(0..i64::MAX, 0..50)) {
        let mut sum = counted(&first);
        sum.add(&counted(&second));
        prop_assert_eq!(sum, counted(&[first, second].concat()));
    }

    #[test]
    fn whatever_bins_come_have_percentiles(bins in prop::collection::vec(any::<u32>(), 0..2000), share: f64) {
        let mut hostile = Latencies { bins };
        let told = hostile.percentile(share);
        prop_assert_eq!(told.is_some(), hostile.count() > 0);
        prop_assert!(told.is_none_or(|nanos| (0..=(1 << 27) * 1000).contains(&nanos)));
        hostile.add(&hostile.clone());
    }
}
