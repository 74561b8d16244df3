//! The bus as nodes use it: real sessions, a real router on loopback, a port chosen by the system.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use bus::{Bus, BusConfig, Presence, Router, Subscriber};
use std::sync::mpsc::{self, TryRecvError};
use std::time::{Duration, Instant};
use wire::topic::{self, Topic};
use wire::{Bulk, Extent, Header, Message, Phase, RunPhase, Scan, codec};

const PATIENCE: Duration = Duration::from_secs(20);

struct Private {
    #[allow(dead_code, reason = "held for its drop")]
    router: Router,
    config: BusConfig,
}

impl Private {
    fn new() -> Self {
        let router = Router::start(&BusConfig::default()).unwrap();
        let config = BusConfig { endpoint: router.endpoint().to_owned(), ..BusConfig::default() };
        Self { router, config }
    }

    fn open(&self) -> Bus {
        Bus::open(&self.config).unwrap()
    }
}

fn scan(stamp_nanos: i64) -> Scan {
    Scan { points: Bulk(vec![]), ..Scan::none(Header { stamp_nanos, phase: Phase::Shape, ..Header::default() }) }
}

fn wait_for<M: Message>(bus: &Bus, input: &mut Subscriber<M>) -> M {
    let deadline = Instant::now() + PATIENCE;
    loop {
        if let Some(message) = input.next() {
            return message;
        }
        assert!(Instant::now() < deadline, "nothing came on {}", input.key());
        bus.wait(Duration::from_millis(100));
    }
}

fn wait_until(bus: &Bus, mut done: impl FnMut() -> bool) {
    let deadline = Instant::now() + PATIENCE;
    while !done() {
        assert!(Instant::now() < deadline, "waited in vain");
        bus.wait(Duration::from_millis(20));
    }
}

fn ready(presence: &Presence) -> Vec<String> {
    presence.nodes().into_iter().collect()
}

#[test]
fn a_late_subscriber_gets_the_whole_stream_in_order() {
    let net = Private::new();
    let (sender, receiver) = (net.open(), net.open());
    let mut scans = sender.publisher(&topic::scan("head")).unwrap();
    for i in 0..500 {
        scans.send(scan(i)).unwrap();
    }
    let mut late = receiver.subscribe(&topic::scan("head"), 4096).unwrap();
    for i in 0..500 {
        assert_eq!(wait_for(&receiver, &mut late).header.stamp_nanos, i);
    }
    scans.send(scan(500)).unwrap();
    assert_eq!(wait_for(&receiver, &mut late).header.stamp_nanos, 500);
    assert_eq!(late.counts().lost, 0);
}

#[test]
fn whoever_joins_while_a_stream_flows_gets_it_from_its_beginning_without_a_gap() {
    let net = Private::new();
    let sender = net.open();
    let (_flows, stopped) = mpsc::channel::<()>();
    std::thread::spawn(move || {
        let mut scans = sender.publisher(&topic::scan("head")).unwrap();
        for i in (0..).take_while(|_| stopped.try_recv() == Err(TryRecvError::Empty)) {
            scans.send(scan(i)).unwrap();
            std::thread::sleep(Duration::from_millis(1));
        }
    });
    for _ in 0..20 {
        let receiver = net.open();
        let mut late = receiver.subscribe(&topic::scan("head"), 1 << 17).unwrap().expecting(0);
        let seen: Vec<i64> = (0..300).map(|_| wait_for(&receiver, &mut late).header.stamp_nanos).collect();
        assert!(seen.iter().copied().eq(0..300), "it began at {}, {:?}", seen[0], late.counts());
    }
}

#[test]
fn what_is_latched_reaches_whoever_subscribes_at_that_very_moment() {
    let net = Private::new();
    for round in 0..100 {
        let mut topic = topic::run_phase();
        topic.key = format!("run/{round}");
        let here = topic.clone();
        let (sender, receiver) = (net.open(), net.open());
        let sending = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_micros(20 * round));
            let mut phases = sender.publisher(&here).unwrap();
            phases.send(RunPhase { header: Header::default(), discard: false }).unwrap();
            // It is kept as long as it has a publisher.
            (sender, phases)
        });
        let mut phases = receiver.subscribe(&topic, 4).unwrap();
        wait_for(&receiver, &mut phases);
        drop(sending.join());
    }
}

#[test]
fn a_full_ring_keeps_the_newest_counts_the_rest_as_lost_and_slows_no_other_topic() {
    let net = Private::new();
    let (sender, receiver) = (net.open(), net.open());
    let mut slow = receiver.subscribe(&topic::scan("slow"), 4).unwrap();
    let mut quick = receiver.subscribe(&topic::scan("quick"), 4).unwrap();
    let mut to_slow = sender.publisher(&topic::scan("slow")).unwrap();
    let mut to_quick = sender.publisher(&topic::scan("quick")).unwrap();
    to_slow.send(scan(0)).unwrap();
    assert_eq!(wait_for(&receiver, &mut slow).header.stamp_nanos, 0);
    for i in 1..=1000 {
        to_slow.send(scan(i)).unwrap();
    }
    to_quick.send(scan(7)).unwrap();
    assert_eq!(wait_for(&receiver, &mut quick).header.stamp_nanos, 7);
    // Both went through the same link in order, so the slow ring has seen all 1000 by now.
    let kept: Vec<i64> = std::iter::from_fn(|| slow.next()).map(|s| s.header.stamp_nanos).collect();
    assert_eq!(kept, [997, 998, 999, 1000]);
    assert_eq!(slow.counts().lost, 996);
}

#[test]
fn a_message_of_another_version_is_refused_by_name_and_garbage_does_no_harm() {
    let net = Private::new();
    let (sender, receiver) = (net.open(), net.open());
    let mut phases = receiver.subscribe(&topic::run_phase(), 16).unwrap();
    // What is sent before the subscription is known at the sender is sent to nobody.
    let _token = receiver.declare_ready("stripe/head").unwrap();
    let presence = sender.presence().unwrap();
    wait_until(&sender, || !ready(&presence).is_empty());
    sender.forward("run/phase", "RunPhase@9:00000000deadbeef", vec![1, 2, 3]).unwrap();
    sender.forward("run/phase", &codec::schema::<RunPhase>(), vec![0xff; 40]).unwrap();
    sender.forward("run/phase", "", vec![]).unwrap();
    let good = RunPhase { header: Header { phase: Phase::Both, ..Header::default() }, discard: false };
    sender.forward("run/phase", &codec::schema::<RunPhase>(), codec::encode(&good)).unwrap();
    assert_eq!(wait_for(&receiver, &mut phases), good);
    let counts = phases.counts();
    assert_eq!((counts.received, counts.refused), (1, 3));
    let other_version = codec::check_schema::<RunPhase>("RunPhase@9:00000000deadbeef").unwrap_err().to_string();
    assert!(other_version.contains("RunPhase@9") && other_version.contains("update"), "{other_version}");
}

#[test]
fn a_restarted_publisher_is_no_loss_and_its_history_is_not_handed_on_twice() {
    let net = Private::new();
    let receiver = net.open();
    let mut fresh = receiver.subscribe(&topic::scan("head"), 64).unwrap().fresh_only();
    let first = net.open();
    let mut scans = first.publisher(&topic::scan("head")).unwrap();
    for i in 0..3 {
        scans.send(scan(i)).unwrap();
        assert_eq!(wait_for(&receiver, &mut fresh).header.stamp_nanos, i);
    }
    first.close().unwrap();
    let again = net.open();
    let mut scans = again.publisher(&topic::scan("head")).unwrap();
    for i in 0..5 {
        scans.send(scan(i)).unwrap();
    }
    assert_eq!(wait_for(&receiver, &mut fresh).header.stamp_nanos, 3);
    assert_eq!(wait_for(&receiver, &mut fresh).header.stamp_nanos, 4);
    assert_eq!((fresh.counts().lost, fresh.counts().repeated), (0, 3));
}

#[test]
fn presence_tells_who_came_and_who_went() {
    let net = Private::new();
    let (node, watcher) = (net.open(), net.open());
    let token = node.declare_ready("stripe/head").unwrap();
    let presence = watcher.presence().unwrap();
    wait_until(&watcher, || ready(&presence) == ["stripe/head"]);
    drop(token);
    wait_until(&watcher, || ready(&presence).is_empty());
}

#[test]
fn rigs_with_different_namespaces_on_one_router_never_meet() {
    let net = Private::new();
    let other = BusConfig { namespace: "other".to_owned(), ..net.config.clone() };
    let (ours, theirs) = (net.open(), Bus::open(&other).unwrap());
    let mut heard = ours.subscribe(&topic::run_phase(), 4).unwrap();
    let phase = |phase| RunPhase { header: Header { phase, ..Header::default() }, discard: false };
    theirs.publisher(&topic::run_phase()).unwrap().send(phase(Phase::Shape)).unwrap();
    let mut own = ours.publisher(&topic::run_phase()).unwrap();
    own.send(phase(Phase::Colour)).unwrap();
    assert_eq!(wait_for(&ours, &mut heard).header.phase, Phase::Colour);
}

#[test]
fn leaving_loopback_without_certificates_is_refused_and_says_what_to_do() {
    let config = BusConfig { endpoint: "0.0.0.0:7447".to_owned(), ..BusConfig::default() };
    let refusal = Router::start(&config).err().unwrap().to_string();
    assert!(refusal.contains("0.0.0.0:7447") && refusal.contains("[bus.tls]"), "{refusal}");
}

#[test]
fn a_million_points_survive_the_way() {
    let net = Private::new();
    let (sender, receiver) = (net.open(), net.open());
    let topic: Topic<wire::Cloud> = topic::cloud();
    let mut clouds = receiver.subscribe(&topic, 4).unwrap();
    let point = |i: u32| wire::CloudPoint { id: i, position_m: [i as f32, 0.5, -1.0], ..Default::default() };
    let sent = wire::Cloud {
        header: Header::default(),
        extent: Extent::Whole,
        table: None,
        points: (0..1_000_000).map(point).collect(),
        refused: vec![],
    };
    sender.publisher(&topic).unwrap().send(sent.clone()).unwrap();
    assert!(wait_for(&receiver, &mut clouds) == sent);
}
