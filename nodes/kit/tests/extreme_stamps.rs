//! Stamps from a device that has lost its clock: late, early or waited for in vain, but no panic.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use kit::{Bus, BusConfig, Node, NodeSpec, Pace};
use std::time::{Duration, Instant};
use wire::{Clock, Header, Phase, Progress, RunPhase, topic};

const EXTREME: [i64; 5] = [i64::MIN, -1, 0, 1, i64::MAX];

/// A source whose scan began at a moment, and the operator's word, which lasts as long as who gave it.
fn source(bus: &Bus, spec: NodeSpec, began_nanos: i64) -> (bus::Publisher<RunPhase>, Node) {
    let header =
        Header { scan: 1, phase: Phase::Both, stamp_nanos: began_nanos, clock: Clock::System, ..Header::default() };
    let mut phases = bus.publisher(&topic::run_phase()).unwrap();
    phases.send(RunPhase { header, discard: false }).unwrap();
    (phases, Node::open_unattended(spec).unwrap())
}

#[test]
fn a_source_in_real_time_sends_what_is_due_and_tells_how_old_it_is() {
    for began_nanos in [i64::MIN, 0] {
        let router = bus::Router::start(&BusConfig::default()).unwrap();
        let config = BusConfig { endpoint: router.endpoint().to_owned(), ..BusConfig::default() };
        let bus = Bus::open(&config).unwrap();
        let mut healths = bus.subscribe(&topic::health("source/a"), 64).unwrap();
        let (_phases, mut node) = source(&bus, NodeSpec::new("source", "a", config), began_nanos);
        let go = node.wait_for_go(None).unwrap().unwrap();
        for stamp_nanos in EXTREME {
            for clock in [Clock::Scan, Clock::System] {
                node.finished(&Header { stamp_nanos, clock, ..Header::default() }).unwrap();
            }
        }
        for stamp_nanos in EXTREME.into_iter().filter(|stamp| began_nanos < 0 || *stamp < i64::MAX) {
            assert!(node.wait_for_turn(&go, stamp_nanos));
        }
        node.close().unwrap();
        let deadline = Instant::now() + Duration::from_secs(20);
        let counted = std::iter::repeat_with(|| {
            bus.wait(Duration::from_millis(50));
            assert!(Instant::now() < deadline, "no account came");
            std::iter::from_fn(|| healths.next()).last().map_or(0, |health| health.latencies.count())
        });
        assert!(counted.into_iter().any(|count| count == 2 * EXTREME.len() as u64));
    }
}

#[test]
fn a_source_at_a_fast_pace_keeps_its_window() {
    let router = bus::Router::start(&BusConfig::default()).unwrap();
    let config = BusConfig { endpoint: router.endpoint().to_owned(), ..BusConfig::default() };
    let bus = Bus::open(&config).unwrap();
    let consumers = vec!["paint/model".to_owned()];
    let spec = NodeSpec { pace: Pace::Fast, window_ms: u64::MAX, consumers, ..NodeSpec::new("source", "a", config) };
    let (_phases, mut node) = source(&bus, spec, 0);
    let go = node.wait_for_go(None).unwrap().unwrap();
    let mut progress = bus.publisher(&topic::progress("paint/model")).unwrap();
    for stamp_nanos in [EXTREME, EXTREME].concat() {
        assert!(node.wait_for_turn(&go, stamp_nanos));
        let header = Header { scan: 1, stamp_nanos, ..Header::default() };
        progress.send(Progress { header, node: "paint/model".to_owned(), finished_seq: 0 }).unwrap();
    }
}
