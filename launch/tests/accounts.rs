//! What the nodes tell of themselves, as the report has it.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use limn::run::Harvest;
use wire::{Header, Health, InputHealth, Latencies, Refusal};

/// An account of one process: the number of the message, and how long each result took.
fn account(seq: u64, results_ms: &[i64]) -> Health {
    let mut latencies = Latencies::default();
    results_ms.iter().for_each(|ms| latencies.note(ms * 1_000_000));
    let count = results_ms.len() as u64;
    Health {
        header: Header { seq, ..Header::default() },
        node: "register/head".to_owned(),
        inputs: vec![InputHealth { key: "profile/head/profile".to_owned(), received: count, lost: 1, refused: 0 }],
        published: count,
        refused: vec![Refusal { reason: "no pose".to_owned(), count: 2 }],
        // What the last second alone says stands for nothing.
        latency_p50_nanos: 1,
        latency_p99_nanos: 1,
        latencies,
        cpu_nanos: 5,
        busy_nanos: 3,
    }
}

#[test]
fn median_and_99_percent_are_of_all_results_in_all_lives_of_a_node() {
    let mut harvest = Harvest::default();
    // 90 results of 10 ms, told of twice as they become more; the process dies, and 10 more take 40 ms.
    harvest.accounts.note(account(0, &[10; 50]));
    harvest.accounts.note(account(1, &[10; 90]));
    harvest.accounts.note(account(0, &[40; 4]));
    harvest.accounts.note(account(1, &[40; 10]));
    let [stage] = &harvest.stages()[..] else { panic!("one node") };
    let told = [stage.latency_p50_ms.unwrap(), stage.latency_p99_ms.unwrap()];
    assert!((told[0] / 10.0 - 1.0).abs() < 0.04 && (told[1] / 40.0 - 1.0).abs() < 0.04, "{told:?} ms");
    assert_eq!((stage.received, stage.published, stage.lost, stage.refused[0].count), (100, 100, 2, 4));
}

#[test]
fn where_no_clock_tells_there_is_no_latency() {
    let mut harvest = Harvest::default();
    harvest.accounts.note(account(0, &[]));
    assert_eq!((harvest.stages()[0].latency_p50_ms, harvest.stages()[0].latency_p99_ms), (None, None));
}
