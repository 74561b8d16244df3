//! A rig on two machines: the same launch file, started on each by hand. Here both are this one, on loopback.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use std::path::Path;
use std::process::Command;
use system_tests::rig::Rig;
use system_tests::{limn, repository, same_bytes, short_sets, short_up};

fn start(launch: &Path, out: &Path) -> Command {
    let mut up = limn();
    up.arg("up").arg(launch);
    short_sets(&mut up, out);
    up
}

#[test]
fn nodes_on_a_second_machine_join_and_the_scan_comes_out_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = ["one", "two"].map(|name| folder.path().join(name));
    let (status, said) = Rig::start(&mut short_up(&one)).end();
    assert!(status.success(), "{said}");

    let launch = folder.path().join("two.toml");
    let text = format!(
        "include = {:?}\n[machines.attic]\n\
         [nodes.stripe]\nmachine = 'attic'\n[nodes.triangulate]\nmachine = 'attic'\n",
        repository("launch/demo.toml"),
    );
    std::fs::write(&launch, text).unwrap();
    let mut here = Rig::start(&mut start(&launch, &two));
    let endpoint = here.config().endpoint;
    let mut away = start(&launch, &two);
    away.args(["--machine", "attic", "--set", &format!("machines.attic.endpoint={endpoint}")]);
    let away = Rig::start(&mut away);
    let (status, said) = here.end();
    assert!(status.success(), "{said}");
    let (status, said_there) = away.end();
    assert!(status.success(), "{said_there}");
    for file in ["cloud.ply", "mesh.ply", "mesh.stl", "model.glb", "model.png"] {
        same_bytes(&one, &two, file);
    }
    // Each says only what its own nodes did.
    assert!(!said.contains("triangulate | "), "{said}");
    assert!(!said_there.contains("cluster | "), "{said_there}");
}

#[test]
fn a_machine_that_the_launch_file_does_not_know_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (status, said) = Rig::start(short_up(folder.path()).args(["--machine", "cellar"])).end();
    assert!(!status.success() && said.contains("[machines.cellar]"), "{said}");
}
