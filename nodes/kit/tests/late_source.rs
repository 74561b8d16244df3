//! A source that cannot keep up with its own time still hears the operator.

use kit::{Bus, BusConfig, Node, NodeSpec};
use std::time::{Duration, Instant};
use wire::{Clock, Header, Phase, RunPhase, topic};

#[test]
fn the_end_reaches_a_source_that_never_rests() {
    let router = bus::Router::start(&BusConfig::default()).unwrap();
    let config = BusConfig { endpoint: router.endpoint().to_owned(), ..BusConfig::default() };
    let operator = Bus::open(&config).unwrap();
    let mut phases = operator.publisher(&topic::run_phase()).unwrap();
    let run = |phase| {
        let header = Header { scan: 1, phase, stamp_nanos: 0, clock: Clock::System, ..Header::default() };
        RunPhase { header, discard: false }
    };
    phases.send(run(Phase::Both)).unwrap();
    let mut source = Node::open_unattended(NodeSpec::new("source", "head", config)).unwrap();
    let go = source.wait_for_go(None).unwrap().unwrap();
    // The scan began in 1970: every stamp is late.
    assert!(source.wait_for_turn(&go, 0));
    phases.send(run(Phase::End)).unwrap();
    let started = Instant::now();
    while source.wait_for_turn(&go, 0) {
        assert!(started.elapsed() < Duration::from_secs(30), "it never heard");
    }
}
