//! A source at a fast pace keeps step with the nodes behind it, and is never held for good.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use kit::{Bus, BusConfig, Go, Node, NodeSpec, Pace};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use wire::{Clock, Header, Phase, Progress, RunPhase, topic};

const CONSUMER: &str = "paint/model";
const SECOND: i64 = 1_000_000_000;

/// What a source needs around it; the operator's word is kept by who gave it.
struct Rig {
    _router: bus::Router,
    _operator: bus::Publisher<RunPhase>,
    bus: Bus,
}

/// A source in a scan that has begun.
fn source() -> (Rig, Node, Go) {
    let router = bus::Router::start(&BusConfig::default()).unwrap();
    let config = BusConfig { endpoint: router.endpoint().to_owned(), ..BusConfig::default() };
    let bus = Bus::open(&config).unwrap();
    let header = Header { scan: 1, phase: Phase::Both, clock: Clock::System, ..Header::default() };
    let mut operator = bus.publisher(&topic::run_phase()).unwrap();
    operator.send(RunPhase { header, discard: false }).unwrap();
    let spec =
        NodeSpec { pace: Pace::Fast, consumers: vec![CONSUMER.to_owned()], ..NodeSpec::new("source", "a", config) };
    let mut node = Node::open_unattended(spec).unwrap();
    let go = node.wait_for_go(None).unwrap().unwrap();
    (Rig { _router: router, _operator: operator, bus }, node, go)
}

fn done(stamp_nanos: i64) -> Progress {
    let header = Header { scan: 1, stamp_nanos, ..Header::default() };
    Progress { header, node: CONSUMER.to_owned(), finished_seq: 0 }
}

#[test]
fn a_node_that_needs_to_know_what_comes_after_does_not_stop_a_slow_source() {
    let (rig, mut source, go) = source();
    let mut progress = rig.bus.publisher(&topic::progress(CONSUMER)).unwrap();
    let started = Instant::now();
    for second in 0..8 {
        assert!(source.wait_for_turn(&go, second * SECOND));
        // It has heard of this second, and can tell of the one before.
        progress.send(done((second - 1).max(0) * SECOND)).unwrap();
    }
    assert!(started.elapsed() < Duration::from_secs(40), "it stood still");
}

#[test]
fn a_source_runs_ahead_by_its_window_and_goes_on_when_the_others_have() {
    const STEP: i64 = SECOND / 100;
    let (rig, mut source, go) = source();
    let mut progress = rig.bus.publisher(&topic::progress(CONSUMER)).unwrap();
    let sent = Arc::new(AtomicUsize::new(0));
    let (stopper, count) = (source.stopper(), sent.clone());
    let at_work = std::thread::spawn(move || {
        while source.wait_for_turn(&go, count.load(Ordering::SeqCst) as i64 * STEP) {
            count.fetch_add(1, Ordering::SeqCst);
        }
    });
    let rest = || {
        std::thread::sleep(Duration::from_secs(2));
        sent.load(Ordering::SeqCst)
    };
    let ahead = rest();
    assert!((30..=60).contains(&ahead), "{ahead} messages ahead of a node that has done nothing");
    progress.send(done(10 * SECOND)).unwrap();
    let further = rest();
    assert!((1030..=1060).contains(&further), "{further} messages when 1000 were done");
    stopper.stop();
    at_work.join().unwrap();
}
