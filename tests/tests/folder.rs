//! A scan as pictures and tables: written beside a rig that is up, and made into a model again.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use std::path::Path;
use system_tests::rig::{Course, Rig, signal, wait_for_ready};
use system_tests::{UNREFINED, limn, lost, number, report, short_up, succeed};

/// `limn model` of an input; all that decides the model is said here, since a folder tells no settings.
fn model(input: &Path, out: &Path) -> serde_json::Value {
    let mut model = limn();
    model.arg("model").arg(input).args(UNREFINED).arg("-o").arg(out);
    for set in ["cluster.table=remove", "surface.drop_islands_mm=5.0", "paint.lamp_from_camera_m=[0.025, -0.015, 0.0]"]
    {
        model.args(["--set", set]);
    }
    succeed(&mut model);
    report(out)
}

#[test]
fn a_scan_folder_gives_the_model_of_its_recording() {
    let place = tempfile::tempdir().unwrap();
    let [live, folder, of_folder, of_recording] =
        ["live", "theirs", "of_folder", "of_recording"].map(|name| place.path().join(name));
    let mut up = short_up(&live);
    up.args(["--set", "run.pace=real", "--set", "run.begin=aim", "--set", "run.once=false"]);
    let mut rig = Rig::start(&mut up);
    let bus = rig.bus();
    let mut course = Course::follow(&bus);
    let mut record = limn();
    record.arg("record").arg(&folder).arg("--as-folder").env("XDG_RUNTIME_DIR", rig.runtime.path());
    let recorder = Rig::start(&mut record);
    let mut name = String::new();
    wait_for_ready(&bus, |node| {
        node.clone_into(&mut name);
        node.starts_with("record/by_hand")
    });
    succeed(limn().args(["scan", "both"]).env("XDG_RUNTIME_DIR", rig.runtime.path()));
    course.wait_for_end(&name);
    course.wait_for_end("export/model");
    signal(recorder.pid(), "INT");
    let (status, said) = recorder.end();
    assert!(status.success() && !said.contains("lost"), "{said}");
    drop(bus);
    signal(rig.pid(), "INT");
    let (status, said) = rig.end();
    assert!(status.success(), "{said}");

    for file in ["rig.toml", "frames.csv", "poses.csv"] {
        assert!(folder.join(file).is_file(), "{file}");
    }
    let recording = folder.with_extension("mcap");
    let (theirs, ours) = (model(&folder, &of_folder), model(&recording, &of_recording));
    assert_eq!((lost(&theirs), lost(&ours)), (0, 0));
    assert_eq!(theirs["counts"]["points"], ours["counts"]["points"]);
    // Which cells are seen at the edges hangs on the last decimal of a pose.
    let [seen, of_ours] = [&theirs, &ours].map(|report| number(report, "/counts/texture_cells"));
    assert!((seen / of_ours - 1.0).abs() < 0.05, "{seen} cells, {of_ours} from the recording");
    let meshes = [&of_folder, &of_recording].map(|out| out.join("mesh.ply"));
    let output = succeed(limn().arg("compare").args(meshes).arg("--json"));
    let comparison: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    println!("{comparison:#}");
    // Times and places went through decimals; the surface must not notice.
    assert!(number(&comparison, "/model_to_truth/max_mm") < 0.01, "{comparison:#}");
}
