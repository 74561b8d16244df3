//! A node that dies in mid-scan is started again, and the model comes out the same: what it needs it gets from latched
//! topics and from what publishers keep. The stripe detector holds no history; the pictures on their way to it are lost,
//! and counted.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use std::path::Path;
use std::sync::OnceLock;
use system_tests::rig::{Course, Rig, signal, wait_until};
use system_tests::{limn, lost, report, same_bytes, short_demo, succeed};
use tempfile::TempDir;

const FILES: [&str; 6] = ["cloud.ply", "mesh.ply", "mesh.stl", "model.glb", "model.obj", "model.png"];
const SECOND: i64 = 1_000_000_000;

/// The same scan, in which nobody dies.
fn undisturbed() -> &'static Path {
    static RUN: OnceLock<TempDir> = OnceLock::new();
    let run = RUN.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        succeed(&mut short_demo(folder.path()));
        folder
    });
    run.path()
}

/// Kills a node and waits until another process has taken its place.
fn kill(rig: &Rig, kind: &str) {
    let first = rig.node(kind).unwrap_or_else(|| panic!("{kind} does not run:\n{}", rig.said()));
    signal(first, "KILL");
    wait_until("it is not started again", || rig.node(kind).is_some_and(|again| again != first));
}

/// Runs the scan, in which the first node of a kind dies when another has come so far; returns its folder.
fn model_without(kind: &str, node: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut rig = Rig::start(&mut short_demo(folder.path()));
    let bus = rig.bus();
    Course::follow(&bus).wait_for(node, 3 * SECOND);
    kill(&rig, kind);
    drop(bus);
    let (status, said) = rig.end();
    assert!(status.success(), "{said}");
    assert!(said.contains("signal: 9") && said.contains("again in"), "{said}");
    let told = report(folder.path());
    assert_eq!(lost(&told), 0, "{said}");
    // What a node sends once more when it lives again counts once.
    assert_eq!(told["counts"]["points"], report(undisturbed())["counts"]["points"], "{said}");
    FILES.iter().for_each(|file| same_bytes(undisturbed(), folder.path(), file));
    folder
}

#[test]
fn of_triangulate() {
    model_without("triangulate", "triangulate/head");
}

#[test]
fn of_register() {
    model_without("register", "register/head");
}

#[test]
fn of_refine() {
    model_without("refine", "refine/refined");
}

#[test]
fn of_cluster() {
    model_without("cluster", "cluster/model");
}

#[test]
fn of_surface() {
    model_without("surface", "cluster/model");
}

#[test]
fn of_paint() {
    model_without("paint", "paint/model");
}

#[test]
fn of_export() {
    model_without("export", "cluster/model");
}

/// What it had written stands, what its death has cost is in its second part, and both are read as one.
#[test]
fn of_record() {
    let folder = model_without("record", "cluster/model");
    let again = folder.path().join("again");
    let scan = folder.path().join("scan.mcap");
    assert!(scan.with_extension("2.mcap").metadata().unwrap().len() > 0);
    let said = succeed(limn().arg("model").arg(&scan).arg("-o").arg(&again)).stderr;
    let said = String::from_utf8_lossy(&said);
    assert!(said.contains("scan.mcap: the recording was not closed"), "{said}");
    FILES.iter().for_each(|file| same_bytes(undisturbed(), &again, file));
}

#[test]
fn pictures_on_their_way_to_a_dying_stripe_detector_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let mut rig = Rig::start(&mut short_demo(folder.path()));
    let bus = rig.bus();
    let mut course = Course::follow(&bus);
    course.wait_for("stripe/head", 3 * SECOND);
    kill(&rig, "stripe");
    course.wait_for_end("stripe/head");
    let done = course.finished.remove("stripe/head").unwrap();
    drop(bus);
    let (status, said) = rig.end();
    let told = report(folder.path());
    // What was gathered is there; that something is missing is no success.
    assert!(!status.success() && said.contains("messages lost"), "{said}");
    for file in FILES {
        assert!(folder.path().join(file).metadata().is_ok_and(|file| file.len() > 0), "{file}: {said}");
    }
    // The numbers that nobody finished are those that were lost, one by one.
    let missing: u64 = done.windows(2).map(|pair| pair[1] - pair[0] - 1).sum();
    assert!(missing > 0, "the detector died and nothing was on its way");
    assert_eq!(lost(&told), missing, "{said}");
}
