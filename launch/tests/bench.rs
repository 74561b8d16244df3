//! The launch file for real hardware says the same as the simulated one, but for where its streams come from.

#![allow(clippy::unwrap_used, reason = "a helper that cannot go on has failed its test")]

use limn::nodes;
use limn::plan::Plan;
use std::path::Path;
use toml::{Table, Value};

fn table(name: &str) -> Table {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    std::fs::read_to_string(path).unwrap().parse().unwrap()
}

/// The file without its sources, and what kinds those are.
fn without_sources(name: &str) -> (Table, Vec<String>) {
    let mut file = table(name);
    let nodes = file["nodes"].as_table_mut().unwrap();
    let kind = |node: &Value| node.get("kind").and_then(Value::as_str).unwrap_or_default().to_owned();
    let is_source = |node: &Value| nodes::find(&kind(node)).is_some_and(|kind| kind.source);
    let mut sources: Vec<String> = nodes.values().filter(|node| is_source(node)).map(kind).collect();
    sources.sort();
    nodes.retain(|_, node| !is_source(node));
    // Each handset has its own calibration.
    file.remove("rig");
    (file, sources)
}

#[test]
fn bench_and_demo_differ_in_their_sources_only() {
    let ((demo, simulated), (bench, real)) = (without_sources("demo.toml"), without_sources("bench.toml"));
    assert_eq!(demo, bench);
    assert_eq!(simulated, ["camera_sim", "tracker_sim"]);
    assert_eq!(real, ["camera_v4l", "light", "tracker_flock"]);
}

#[test]
fn bench_can_be_started() {
    let plan = Plan::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("bench.toml"), &[], nodes::KINDS).unwrap();
    assert_eq!(plan.warnings, Vec::<String>::new());
}

#[test]
fn its_camera_is_set_as_a_webcam_wants_it_and_to_the_size_of_its_rig() {
    let (bench, rig) = (table("bench.toml"), table("handset.toml"));
    let camera = &bench["nodes"]["camera"]["config"];
    assert_eq!(bench["rig"]["file"].as_str(), Some("handset.toml"));
    for key in ["width", "height"] {
        assert_eq!(camera[key], rig["camera"][key]);
    }
    assert_eq!(camera["stamp_at"].as_str(), Some("end"));
    assert!(camera.get("white_balance_k").is_some() && camera.get("exposure_us").is_some());
}
