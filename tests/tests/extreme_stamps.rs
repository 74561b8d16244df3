//! A recording of devices that had lost their clocks is played to its end.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use bus::{Bus, BusConfig, Router, Subscriber};
use kit::{Node, NodeSpec, Pace};
use record::Recorder;
use std::path::Path;
use system_tests::rig::wait_on;
use wire::{Bulk, Calibration, Clock, Header, Light, Message, Phase, Pose, RunPhase, Stripe, codec, topic};

const STAMPS: [i64; 8] = [5, i64::MIN, i64::MAX, 6, -1, 0, i64::MAX - 1, 7];

fn record(path: &Path) {
    fn put<M: Message>(recorder: &mut Recorder, topic: &topic::Topic<M>, message: &M) {
        let stamp_nanos = message.header().stamp_nanos;
        recorder.write(&topic.key, &codec::schema::<M>(), stamp_nanos, &codec::encode(message)).unwrap();
    }
    let mut recorder = Recorder::create(path, record::Config::default(), &Default::default()).unwrap();
    let rig = std::fs::read_to_string(system_tests::repository("config/rigs/paper.toml")).unwrap();
    let calibration: Calibration = geometry::Rig::parse(&rig).unwrap().calibration().unwrap();
    put(&mut recorder, &topic::calibration("head"), &calibration);
    for stamp_nanos in STAMPS {
        let header = Header { phase: Phase::Both, stamp_nanos, clock: Clock::System, ..Header::default() };
        put(&mut recorder, &topic::pose("head"), &Pose::none(header, "no clock"));
        let light = Light { laser: true, lamp: false };
        let stripe = Stripe { header, width: 1, height: 1, light, peaks: Bulk::default(), refused: Vec::new() };
        put(&mut recorder, &topic::stripe("head"), &stripe);
    }
    recorder.finish().unwrap();
}

/// The stamps of all that comes, up to the end.
fn all<M: Message>(bus: &Bus, input: &mut Subscriber<M>) -> Vec<i64> {
    let mut stamps = Vec::new();
    loop {
        let header = *wait_on(bus, "the end of the stream", || input.next()).header();
        if header.is_end() {
            return stamps;
        }
        stamps.push(header.stamp_nanos);
    }
}

#[test]
fn is_played_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scan.mcap");
    record(&path);
    for pace in [Pace::Real, Pace::Fast] {
        let router = Router::start(&BusConfig::default()).unwrap();
        let config = BusConfig { endpoint: router.endpoint().to_owned(), ..BusConfig::default() };
        let bus = Bus::open(&config).unwrap();
        let mut poses = bus.subscribe(&topic::pose("head"), 64).unwrap();
        let mut stripes = bus.subscribe(&topic::stripe("head"), 64).unwrap();
        let header = Header { scan: 1, phase: Phase::Both, ..Header::default() };
        let mut phases = bus.publisher(&topic::run_phase()).unwrap();
        phases.send(RunPhase { header, discard: false }).unwrap();

        let config = NodeSpec { pace, ..NodeSpec::new("replay", "head", config) };
        let spec = NodeSpec { config: serde_json::json!({ "file": path, "stripes": true }), ..config };
        let node = Node::open_unattended(spec).unwrap();
        let stopper = node.stopper();
        let playing = std::thread::spawn(move || replay::node::run(node));
        assert_eq!(all(&bus, &mut stripes), STAMPS, "{pace:?}");
        assert_eq!(all(&bus, &mut poses), STAMPS, "{pace:?}");
        stopper.stop();
        playing.join().unwrap().unwrap();
    }
}
