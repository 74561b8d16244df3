//! What should never come, from one end to the other: messages of another version, garbage, and a scan of nothing.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use std::collections::BTreeMap;
use system_tests::rig::{Course, Rig};
use system_tests::{lost, report, same_bytes, short_demo, succeed};
use wire::{Header, Message, Pose, RunPhase, codec, topic};

/// What comes on one key: as a later version of limn would write it, and as ours does.
struct Stream {
    key: String,
    newer: String,
    ours: String,
}

/// Schemas of all messages, by their names: newer and ours.
fn schemas() -> BTreeMap<&'static str, (String, String)> {
    fn newer<M: Message>() -> String {
        format!("{}@{}:00000000deadbeef", M::NAME, M::VERSION + 1)
    }
    macro_rules! all {
        ($($message:ty),*) => {
            BTreeMap::from([$((<$message>::NAME, (newer::<$message>(), codec::schema::<$message>()))),*])
        };
    }
    wire::for_all_messages!(all)
}

/// Every key of a demo's rig, with what may come on it.
fn streams() -> Vec<Stream> {
    let schemas = schemas();
    let on = |(key, name, _class): (String, &str, topic::Class)| {
        let (newer, ours) = schemas[name].clone();
        let instances: &[&str] = match key.split('/').next() {
            _ if !key.contains('*') => &[""],
            Some("world") => &["head", "refined"],
            Some("@health" | "@progress" | "@log") => &["stripe/head"],
            _ => &["head"],
        };
        instances
            .iter()
            .map(|instance| Stream { key: key.replace('*', instance), newer: newer.clone(), ours: ours.clone() })
            .collect::<Vec<_>>()
    };
    topic::all().into_iter().flat_map(on).collect()
}

/// A header and nothing behind it, with the highest number there is.
fn last_header() -> Vec<u8> {
    let header = Header { seq: u64::MAX, ..Header::default() };
    let mut bytes = codec::encode(&RunPhase { header, discard: false });
    bytes.pop();
    bytes
}

/// Whether a node of a demo without a page hears it all the time, and so has something to say of it. Of models the exporter
/// keeps the newest two, and so may never see what came before them.
fn is_heard(key: &str) -> bool {
    let unheard = ["model/textured", "rig/", "truth/", "world/refined/refinement", "world/head/refinement", "@"];
    !unheard.iter().any(|start| key.starts_with(start))
}

#[test]
fn a_newer_message_is_named_garbage_is_counted_and_the_scan_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let [quiet, noisy] = ["quiet", "noisy"].map(|name| folder.path().join(name));
    succeed(&mut short_demo(&quiet));
    // With an onlooker, who hears all of it as well; without its page, which nothing opens.
    let mut rig = Rig::start(short_demo(&noisy).args(["--set", "nodes.view.enabled=true", "--set", "view.page=false"]));
    let bus = rig.bus();
    Course::follow(&bus).wait_for("cluster/model", 1_000_000_000);
    let streams = streams();
    for Stream { key, newer, ours } in &streams {
        // Both begin like a message: the first one of its publisher, and one behind which none can come.
        bus.forward(key, ours, vec![0; 40]).unwrap();
        bus.forward(key, ours, last_header()).unwrap();
        // Of what is latched some hold no more than four.
        bus.forward(key, newer, vec![1, 2, 3]).unwrap();
        bus.forward(key, ours, vec![0xff; 40]).unwrap();
        bus.forward(key, "", vec![]).unwrap();
        bus.forward(key, "Nonsense@1:0", vec![0xff; 40]).unwrap();
    }
    // Whole messages, though their numbers are not the tracker's.
    for seq in [0, u64::MAX] {
        let pose = Pose::none(Header { seq, ..Header::default() }, "nobody sent it");
        bus.forward(&topic::pose("head").key, &codec::schema::<Pose>(), codec::encode(&pose)).unwrap();
    }
    drop(bus);
    let (status, said) = rig.end();
    assert!(status.success(), "{said}");
    assert!(!said.contains("panicked") && !said.contains("again in"), "{said}");
    let told = report(&noisy);
    assert_eq!(lost(&told), 0, "{said}");
    for file in ["cloud.ply", "mesh.ply", "model.glb"] {
        same_bytes(&quiet, &noisy, file);
    }
    let log = std::fs::read_to_string(noisy.join("log.txt")).unwrap();
    for Stream { key, newer, ours } in streams.iter().filter(|stream| is_heard(&stream.key)) {
        let named = |line: &&str| line.contains(key.as_str()) && line.contains(newer.as_str());
        let line = log.lines().find(named).unwrap_or_else(|| panic!("{key} is not named in the log:\n{log}"));
        assert!(line.contains(ours.as_str()) && line.contains("this node is the older one: update it"), "{line}");
        assert!(
            log.lines().any(|line| line.contains(key.as_str()) && line.contains("40 bytes are no")),
            "{key}: {log}"
        );
    }
    // Who reads it says so in its own name, and the report counts it.
    assert!(log.lines().any(|line| line.trim_start().starts_with("stripe | ERROR camera/head/frame")), "{log}");
    let refused = |node: &str| {
        let stages = told["stages"].as_array().unwrap();
        let stage = stages.iter().find(|stage| stage["node"] == node).unwrap();
        stage["refused"].as_array().unwrap().iter().filter_map(|r| r["count"].as_u64()).sum::<u64>()
    };
    for node in ["stripe/head", "triangulate/head", "register/head", "cluster/model", "surface/model", "paint/model"] {
        assert!(refused(node) >= 3, "{node}: {told:#}");
    }
}

#[test]
fn a_scan_of_nothing_ends_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut rig = short_demo(folder.path());
    rig.args(["--set", "stripe.min_amplitude=250"]);
    let (status, said) = Rig::start(&mut rig).end();
    assert!(!status.success(), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    assert!(said.contains("no stripe was seen"), "{said}");
    let told = report(folder.path());
    assert_eq!((lost(&told), told["counts"]["points"].as_u64()), (0, Some(0)), "{said}");
    // What was measured is kept: another setting may find it.
    assert!(folder.path().join("scan.mcap").metadata().unwrap().len() > 0);
    assert!(folder.path().join("report.html").is_file());
}
