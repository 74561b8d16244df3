//! Whoever only looks: a viewer that is stuck slows nobody, and one that comes late sees what there is.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use kit::NodeSpec;
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;
use std::time::Instant;
use system_tests::rig::{Course, Rig, first, signal, wait_for_ready, wait_on};
use system_tests::{limn, lost, report, same_bytes, short_demo, short_up, succeed};
use wire::topic;

#[test]
fn a_stuck_viewer_slows_nobody() {
    let folder = tempfile::tempdir().unwrap();
    let [alone, stuck] = ["alone", "stuck"].map(|name| folder.path().join(name));
    let watched = |out: &Path| {
        let mut demo = short_demo(out);
        // With its page's data, without the page: nothing opens it.
        demo.args(["--set", "nodes.view.enabled=true", "--set", "view.page=false"]);
        demo
    };
    succeed(&mut watched(&alone));
    let started = Instant::now();
    let mut rig = Rig::start(&mut watched(&stuck));
    let bus = rig.bus();
    let mut course = Course::follow(&bus);
    course.wait_for("stripe/head", 1_000_000_000);
    let view = rig.node("view").unwrap();
    signal(view, "STOP");
    let swept = Instant::now();
    course.wait_for_end("export/model");
    println!("{:?} from the stop to the model", swept.elapsed());
    signal(view, "CONT");
    drop(bus);
    let (status, said) = rig.end();
    println!("{:?} in all", started.elapsed());
    assert!(status.success(), "{said}");
    assert_eq!(lost(&report(&stuck)), 0, "{said}");
    same_bytes(&alone, &stuck, "model.glb");
}

#[test]
fn colour_comes_on_while_the_hand_still_moves() {
    let folder = tempfile::tempdir().unwrap();
    let mut up = short_up(folder.path());
    for set in ["run.pace=real", "surface.live_every_s=0.2", "paint.live_every_s=0.2"] {
        up.args(["--set", set]);
    }
    let mut rig = Rig::start(&mut up);
    let bus = rig.bus();
    let mut models = bus.subscribe(&topic::textured(), 256).unwrap();
    let live = wait_on(&bus, "no surface is painted before the end", || models.next());
    assert!(!live.header.is_end() && live.header.scan == 1, "{:?}", live.header);
    assert!(live.texture.iter().any(|texel| texel[3] == 255), "no cell of it was seen");
    let last = wait_on(&bus, "no model at the end", || models.next().filter(|model| model.header.is_end()));
    assert!(last.texture.len() > live.texture.len(), "{} {}", last.texture.len(), live.texture.len());
    drop((models, bus));
    let (status, said) = rig.end();
    assert!(status.success(), "{said}");
}

#[test]
fn who_comes_late_gets_calibration_surface_and_model() {
    let folder = tempfile::tempdir().unwrap();
    let mut rig = Rig::start(short_up(folder.path()).args(["--set", "run.once=false"]));
    let bus = rig.bus();
    Course::follow(&bus).wait_for_end("export/model");
    drop(bus);

    let late = rig.bus();
    assert_eq!(first(&late, &topic::calibration("head")).camera.width, 768);
    let mesh = first(&late, &topic::mesh());
    assert!(mesh.header.is_end() && !mesh.triangles.is_empty());
    assert!(!first(&late, &topic::textured()).texture.is_empty());
    assert!(first(&late, &topic::run_phase()).header.scan == 1);

    // The viewer itself, started by hand.
    let mut spec = NodeSpec::new("view", "late", rig.config());
    let page = folder.path().join("late.rrd");
    spec.config = serde_json::json!({ "save": page });
    let mut view = limn();
    view.args(["node", "view", "--instance", "late"]).stdin(Stdio::piped()).stderr(Stdio::null());
    let mut view = view.spawn().unwrap();
    let mut lifeline = view.stdin.take().unwrap();
    writeln!(lifeline, "{}", serde_json::to_string(&spec).unwrap()).unwrap();
    wait_for_ready(&late, |node| node == "view/late");
    let mut healths = late.subscribe(&topic::health("view/late"), 64).unwrap();
    let seen = |health: &wire::Health, key: &str| {
        health.inputs.iter().find(|input| input.key == key).is_some_and(|input| input.received > 0)
    };
    wait_on(&late, "the late viewer sees no model", || {
        healths
            .next()
            .filter(|health| ["model/cloud", "model/mesh", "model/textured"].iter().all(|key| seen(health, key)))
    });
    drop(lifeline);
    assert!(view.wait().unwrap().success());
    assert!(page.metadata().unwrap().len() > 10_000);

    drop(late);
    signal(rig.pid(), "INT");
    let (status, said) = rig.end();
    assert!(status.success(), "{said}");
}
