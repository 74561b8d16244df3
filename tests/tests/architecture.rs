//! Who may know whom: read from `cargo metadata`, so that it cannot drift from ARCHITECTURE.md unseen.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Library of the simulator's world: no node.
const WORLD: &str = "world";
/// Library of the trackers on serial ports: no node.
const SERIAL_LINE: &str = "serial_line";
/// Library of what is plugged in: no node.
const DEVICES: &str = "devices";
const NODES: [&str; 18] = [
    "camera_sim",
    "camera_v4l",
    "light",
    "tracker_sim",
    "tracker_flock",
    "tracker_polhemus",
    "fuse",
    "stripe",
    "triangulate",
    "register",
    "refine",
    "cluster",
    "surface",
    "paint",
    "export",
    "record",
    "replay",
    "view",
];

/// Each member of the workspace with what it depends on (not for its tests), ours and others'.
fn dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.toml");
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--offline", "--format-version", "1", "--manifest-path", manifest])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let names = |package: &Value| {
        let all = package["dependencies"].as_array().unwrap();
        let real = all.iter().filter(|dependency| dependency["kind"] != "dev");
        real.map(|dependency| dependency["name"].as_str().unwrap().to_owned()).collect()
    };
    let packages = metadata["packages"].as_array().unwrap();
    packages.iter().map(|package| (package["name"].as_str().unwrap().to_owned(), names(package))).collect()
}

#[test]
fn each_crate_knows_only_what_it_may() {
    let all = dependencies();
    let ours: BTreeSet<&str> = all.keys().map(String::as_str).collect();
    let mut allowed: BTreeMap<&str, Vec<&str>> = BTreeMap::from([
        ("wire", vec![]),
        ("geometry", vec!["wire"]),
        ("formats", vec!["wire", "geometry"]),
        ("bus", vec!["wire"]),
        ("kit", vec!["wire", "bus"]),
        (WORLD, vec!["wire", "geometry", "formats"]),
        (SERIAL_LINE, vec!["wire", "kit"]),
        (DEVICES, vec![]),
        // The proof of camera_v4l on a real driver.
        ("on_vivid", vec!["camera_v4l", DEVICES, "wire", "bus", "kit"]),
        ("report", vec!["wire", "geometry", "formats"]),
    ]);
    for node in NODES {
        allowed.insert(node, vec!["wire", "geometry", "formats", "kit"]);
    }
    allowed.insert("camera_sim", vec!["wire", "geometry", "formats", "kit", WORLD]);
    allowed.insert("tracker_sim", vec!["wire", "geometry", "formats", "kit", WORLD]);
    allowed.insert("tracker_flock", vec!["wire", "geometry", "formats", "kit", SERIAL_LINE]);
    allowed.insert("tracker_polhemus", vec!["wire", "geometry", "formats", "kit", SERIAL_LINE]);
    allowed.insert("light", vec!["wire", "kit", SERIAL_LINE]);
    allowed.insert("camera_v4l", vec!["wire", "kit", DEVICES]);
    for (name, dependencies) in &all {
        let Some(allowed) = allowed.get(name.as_str()) else {
            assert!(matches!(name.as_str(), "limn" | "system_tests"), "{name} is not in ARCHITECTURE.md's table");
            continue;
        };
        for dependency in dependencies.iter().filter(|dependency| ours.contains(dependency.as_str())) {
            assert!(allowed.contains(&dependency.as_str()), "{name} must not know {dependency}");
        }
    }
}

#[test]
fn what_is_heavy_or_may_change_is_named_by_one_crate_alone() {
    let owners = [
        ("zenoh", "bus"),
        ("zenoh-ext", "bus"),
        ("bincode", "wire"),
        ("rerun", "view"),
        ("parry3d", "geometry"),
        ("serialport", SERIAL_LINE),
        ("v4l", "camera_v4l"),
    ];
    for (name, dependencies) in dependencies() {
        for (library, owner) in owners {
            assert!(!dependencies.contains(library) || name == owner, "{name} names {library}; only {owner} may");
        }
    }
}

/// All sources below a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let here = files.into_iter().filter(|path| path.extension().is_some_and(|ending| ending == "rs"));
    here.chain(folders.iter().flat_map(|folder| sources(folder))).collect()
}

#[test]
fn no_node_reads_the_truth() {
    let nodes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../nodes");
    let mut read = 0;
    for node in NODES {
        for path in sources(&nodes.join(node).join("src")) {
            let text = std::fs::read_to_string(&path).unwrap();
            read += 1;
            // A comment may speak of it.
            let mut code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
            let found = code.find(|line| line.contains("truth"));
            // The camera of the simulator is the one that publishes it.
            assert!(found.is_none() || node == "camera_sim", "{}: {found:?}", path.display());
        }
    }
    assert!(read > NODES.len(), "{read} files: where are the sources?");
}
