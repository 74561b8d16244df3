//! The rigs that are up.

#![allow(clippy::unwrap_used, reason = "a helper that cannot go on has failed its test")]

use bus::BusConfig;
use limn::running::{Running, all, announce, find};

#[test]
fn a_rig_is_found_while_it_is_up() {
    let folder = tempfile::tempdir().unwrap();
    assert!(find(folder.path(), None).unwrap_err().to_string().contains("no rig is up"));
    let demo = announce(folder.path(), "demo", &BusConfig::default()).unwrap();
    assert_eq!(find(folder.path(), None).unwrap().name, "demo");
    let twice = announce(folder.path(), "demo", &BusConfig::default()).err().unwrap();
    assert!(twice.to_string().contains("up already"), "{twice}");
    let bench = announce(folder.path(), "bench", &BusConfig::default()).unwrap();
    assert!(find(folder.path(), None).unwrap_err().to_string().contains("several rigs are up (bench, demo)"));
    assert!(find(folder.path(), Some("attic")).is_err());
    drop(demo);
    assert_eq!(find(folder.path(), None).unwrap().name, "bench");
    drop(bench);
    assert!(all(folder.path()).unwrap().is_empty());
}

#[test]
fn what_a_killed_launcher_left_behind_is_cleared_away() {
    let folder = tempfile::tempdir().unwrap();
    let stale = Running { name: "demo".into(), bus: BusConfig::default(), pid: std::process::id(), started_ticks: 1 };
    let path = folder.path().join("demo.json");
    std::fs::write(&path, serde_json::to_vec(&stale).unwrap()).unwrap();
    std::fs::write(folder.path().join("garbage.json"), "{").unwrap();
    assert!(all(folder.path()).unwrap().is_empty());
    assert!(!path.exists());
}
