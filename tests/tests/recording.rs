//! A recording, as whoever has nothing but the program and the file meets it.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use record::{Config, Recorder};
use replay::Recording;
use std::fs::File;
use system_tests::{limn, lost, number, report, same_bytes, short_demo, succeed};

#[test]
fn a_recording_is_replayed_and_modelled_from_any_folder() {
    let place = tempfile::tempdir().unwrap();
    let [live, replayed, model] = ["live", "replayed", "model"].map(|name| place.path().join(name));
    succeed(&mut short_demo(&live));
    let scan = live.join("scan.mcap");

    // Nothing of the project lies there.
    let elsewhere = tempfile::tempdir().unwrap();
    let mut replay = limn();
    replay
        .arg("replay")
        .arg(&scan)
        .args(["--set", "run.pace=fast", "--set"])
        .arg(format!("export.folder={replayed:?}"));
    succeed(replay.current_dir(elsewhere.path()).env("XDG_RUNTIME_DIR", elsewhere.path()));
    let left: Vec<_> = std::fs::read_dir(elsewhere.path().join("limn")).unwrap().collect();
    assert!(left.is_empty(), "{left:?}");
    for file in ["cloud.ply", "mesh.ply", "model.glb"] {
        same_bytes(&live, &replayed, file);
    }

    succeed(limn().arg("model").arg(&scan).arg("-o").arg(&model).current_dir(elsewhere.path()));
    // Nobody knows its truth, so the page tells what the scan says of itself.
    let told = report(&model);
    for path in ["/refinement/residual_before_mm", "/refinement/residual_after_mm", "/refinement/observed/crossing"] {
        assert!(number(&told, path) > 0.0, "{path}: {told:#}");
    }
    let page = std::fs::read_to_string(model.join("report.html")).unwrap();
    for words in [
        "How well it is known",
        "What refinement has done",
        "Before refinement",
        "Residuals",
        "Expected error",
        "Each laser-lit picture",
    ] {
        assert!(page.contains(words), "{words}");
    }
    let refine = told["stages"].as_array().unwrap().iter().find(|stage| stage["node"] == "refine/refined").unwrap();
    let [busy, others] = [number(refine, "/busy_s"), number(refine, "/cpu_s")];
    assert!(busy > 0.0 && others > 0.0);
}

#[test]
fn a_recording_that_was_cut_short_is_modelled_as_far_as_it_goes() {
    let place = tempfile::tempdir().unwrap();
    let [live, model, nothing] = ["live", "model", "nothing"].map(|name| place.path().join(name));
    succeed(&mut short_demo(&live));
    let scan = live.join("scan.mcap");
    let length = scan.metadata().unwrap().len();
    let cut = |to: u64| File::options().write(true).open(&scan).unwrap().set_len(to).unwrap();

    cut(length * 7 / 10);
    let output = limn().arg("model").arg(&scan).arg("-o").arg(&model).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("it ends"), "what is missing is said: {said}");
    let [whole, part] = [&live, &model].map(|out| number(&report(out), "/counts/points"));
    assert!(part > 0.4 * whole && part < whole, "{part} of {whole} points");
    assert_eq!(lost(&report(&model)), 0, "{said}");
    assert!(model.join("model.glb").is_file());

    cut(100);
    let output = limn().arg("model").arg(&scan).arg("-o").arg(&nothing).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && said.contains("scan.mcap") && !said.contains("panicked"), "{said}");
}

#[test]
fn bad_places_in_a_recording_cost_refinement_no_more_than_themselves() {
    let place = tempfile::tempdir().unwrap();
    let [live, refined] = ["live", "refined"].map(|name| place.path().join(name));
    succeed(&mut short_demo(&live));
    let recording = Recording::open(&live.join("scan.mcap")).unwrap();
    let bad = place.path().join("bad.mcap");
    // The same once more, with what others sent in between.
    let mut recorder = Recorder::create(&bad, Config::default(), &recording.metadata()).unwrap();
    for message in recording.messages().unwrap().map(Result::unwrap) {
        recorder.write(&message.key, &message.schema, message.stamp_nanos, &message.bytes).unwrap();
        if message.key.starts_with("tracker/") {
            recorder.write(&message.key, "Pose@999:1", message.stamp_nanos, b"newer").unwrap();
            recorder.write(&message.key, &message.schema, message.stamp_nanos, &[0; 40]).unwrap();
        }
    }
    recorder.finish().unwrap();
    let mut bytes = std::fs::read(&bad).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    std::fs::write(&bad, bytes).unwrap();

    let output = succeed(limn().arg("refine").arg(&bad).arg("-o").arg(&refined));
    let said = String::from_utf8_lossy(&output.stderr);
    for told in ["is damaged", "got Pose@999:1", "40 bytes are no Pose"] {
        assert!(said.lines().any(|line| line.contains("left out, ") && line.contains(told)), "{told}: {said}");
    }
    assert!(refined.join("mesh.ply").metadata().unwrap().len() > 10_000);
    for file in ["trajectory.csv", "evidence.json"] {
        assert!(refined.join(file).is_file(), "{file}");
    }
}
