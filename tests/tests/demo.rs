//! The demo as a user runs it, on a short sweep: what comes out, and that the same comes out again.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use std::collections::BTreeMap;
use std::path::Path;
use system_tests::{limn, lost, number, report, same_bytes, succeed};

#[test]
fn a_short_sweep_gives_an_exact_coloured_model_and_its_recording_gives_it_again() {
    let folder = tempfile::tempdir().unwrap();
    let [live, again, once_more] = ["live", "again", "once_more"].map(|name| folder.path().join(name));
    succeed(limn().args(["demo", "--headless", "--rig", "fine", "--seconds", "12", "--out"]).arg(&live));
    let told = report(&live);
    for file in [
        "truth.ply",
        "cloud.ply",
        "mesh.ply",
        "mesh.stl",
        "model.glb",
        "model.obj",
        "model.mtl",
        "model.png",
        "scan.mcap",
        "report.html",
        "config.toml",
        "log.txt",
    ] {
        assert!(live.join(file).metadata().is_ok_and(|file| file.len() > 0), "{file} is missing or empty");
    }
    assert_eq!(lost(&told), 0);
    assert!(number(&told, "/counts/points") > 100_000.0);
    assert!(number(&told, "/comparison/model_to_truth/rms_mm") < 0.25);
    assert!(number(&told, "/comparison/model_to_truth/p95_mm") < 0.6);
    assert!(number(&told, "/colour/rms_255") < 8.0);
    // In 12 s the hand does not get everywhere: measured 0.80 (0.97 in a minute).
    let within = told.pointer("/comparison/seen_truth_to_model/within").and_then(|w| w.as_array()).unwrap();
    let within_1_mm = within.iter().find(|w| number(w, "/distance_mm") == 1.0).unwrap();
    assert!(number(within_1_mm, "/share") > 0.75, "{within_1_mm}");

    // With the settings that the recording was made with.
    for out in [&again, &once_more] {
        succeed(limn().arg("model").arg(live.join("scan.mcap")).arg("-o").arg(out));
        assert_eq!(lost(&report(out)), 0);
    }
    for file in ["cloud.ply", "mesh.ply", "mesh.stl", "model.glb", "model.obj", "model.png"] {
        same_bytes(&again, &once_more, file);
        same_bytes(&live, &again, file);
    }
}

#[test]
fn a_tracker_that_is_3_degrees_wrong_gives_a_cow_that_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    succeed(limn().args(["demo", "--headless", "--rig", "paper", "--seconds", "40", "--out"]).arg(&out));
    let told = report(&out);
    assert_eq!(lost(&told), 0);
    let refined = number(&told, "/aligned/comparison/model_to_truth/rms_mm");
    let without = number(&told, "/refinement/without/comparison/model_to_truth/rms_mm");
    assert!(refined < 0.4, "{refined} mm rms");
    // The surface says how wrong it may be: 68 and 95 % would be a normal distribution's, measured 74 and 91.
    let [one, two] = ["/stated/within_one", "/stated/within_two"].map(|share| number(&told, share));
    assert!((0.55..0.9).contains(&one) && (0.85..0.995).contains(&two), "{one} {two}");
    assert!(without > 5.0, "the tracker alone would give {without} mm rms: is this the paper's tracker?");
    assert_eq!(told.pointer("/closed/watertight").and_then(serde_json::Value::as_bool), Some(true));
    assert!(number(&told, "/closed/unmeasured_share") < 0.3 && number(&told, "/closed/caps_to_truth/rms_mm") < 3.0);
    // To print and to show it is closed; what was measured is open below.
    for (file, closed) in [("mesh.stl", true), ("model.glb", true), ("model.obj", true), ("mesh.ply", false)] {
        assert_eq!(is_watertight(&out.join(file)), closed, "{file}");
    }

    // The refinement alone, on the recording, comes to the same.
    let alone = folder.path().join("alone");
    succeed(limn().arg("refine").arg(out.join("scan.mcap")).args(["--compare", "-o"]).arg(&alone));
    for file in ["before.ply", "trajectory.csv", "evidence.json"] {
        assert!(alone.join(file).metadata().is_ok_and(|file| file.len() > 0), "{file} is missing or empty");
    }
    same_bytes(&out, &alone, "mesh.ply");
}

/// Whether as many triangles run along every edge one way as the other. A texture wants a vertex for each of its charts, so
/// edges are told by their places.
fn is_watertight(path: &Path) -> bool {
    let mesh = formats::mesh::read_z_up(path).unwrap().mesh;
    let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    for t in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(t).map(|p| <[f32; 3]>::from(p).map(|x| (x + 0.0).to_bits()));
        // Two corners at one place make no edge.
        for (from, to) in [(a, b), (b, c), (c, a)].into_iter().filter(|(from, to)| from != to) {
            *edges.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
        }
    }
    edges.values().all(|&balance| balance == 0)
}

#[test]
fn what_cannot_be_scanned_is_said_before_anything_is_started() {
    let folder = tempfile::tempdir().unwrap();
    let points_only = folder.path().join("points.obj");
    std::fs::write(&points_only, "v 0 0 0\nv 1 0 0\nv 0 1 0\n").unwrap();
    let broken_rig = folder.path().join("rig.toml");
    std::fs::write(&broken_rig, "[camera]\nwidth = 0\n").unwrap();
    let cases: [(&str, &Path, &str); 4] = [
        ("--object", Path::new("/no/such/cow.obj"), "/no/such/cow.obj"),
        ("--object", &points_only, "faces"),
        ("--rig", &broken_rig, "rig.toml"),
        ("--scene", Path::new("/no/such/scene.toml"), "/no/such/scene.toml"),
    ];
    for (option, path, named) in cases {
        let out = folder.path().join("out");
        let output = limn().args(["demo", "--headless", option]).arg(path).arg("--out").arg(out).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains(named), "{option} {}: {said}", path.display());
        assert!(!said.contains("panicked"), "{said}");
    }
}
