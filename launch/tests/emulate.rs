//! `limn emulate`, as a person starts and stops it.

#![allow(clippy::unwrap_used, reason = "a helper that cannot go on has failed its test")]

use limn::nodes::KINDS;
use limn::plan::Plan;
use limn::planned::PlannedNode;
use std::io::{BufRead as _, BufReader};
use std::os::unix::fs::FileTypeExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn emulate(device: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_limn"));
    command.args(["emulate", device, "--seconds", "2", "--rig"]).arg(repository("config/rigs/fine.toml"));
    command.arg("--scene").arg(repository("config/scenes/cow.toml")).stdin(Stdio::null());
    command
}

#[test]
fn it_says_where_it_is_and_leaves_no_link_behind() {
    let folder = tempfile::tempdir().unwrap();
    for (device, name) in [("flock", "a Flock of Birds is on /dev/"), ("polhemus", "a Liberty is on /dev/")] {
        let link = folder.path().join(device);
        // What a run before left, which was killed.
        std::os::unix::fs::symlink("/no/such/port", &link).unwrap();
        let mut child = emulate(device).arg("--link").arg(&link).stdout(Stdio::piped()).spawn().unwrap();
        let mut said = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut said).unwrap();
        assert!(said.starts_with(name) && said.contains(device), "{said}");
        assert!(std::fs::metadata(&link).unwrap().file_type().is_char_device());
        let interrupted = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        assert!(interrupted.success() && child.wait().unwrap().success());
        assert!(!link.is_symlink(), "{device}");
    }
}

#[test]
fn the_launch_file_for_it_differs_from_the_demos_in_its_tracker_alone() {
    let load = |name: &str| Plan::load(&repository(name), &[], KINDS).unwrap();
    let (demo, emulated) = (load("launch/demo.toml"), load("launch/emulated.toml"));
    assert_eq!(emulated.warnings, demo.warnings);
    let of = |plan: &Plan, tracker: &str| -> Vec<PlannedNode> {
        // The recorder notes the whole launch file.
        plan.nodes.iter().filter(|node| ![tracker, "record"].contains(&node.name.as_str())).cloned().collect()
    };
    assert_eq!(of(&demo, "tracker"), of(&emulated, "flock"));
    let gives = |plan: &Plan, name: &str| plan.nodes.iter().find(|node| node.name == name).unwrap().gives.clone();
    assert_eq!(gives(&demo, "tracker"), gives(&emulated, "flock"));
}

#[test]
fn each_sensor_of_a_tracker_has_poses_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let given = |kind: &str, sensors: &str, fused: &str| {
        let file = folder.path().join("rig.toml");
        let fuse = format!(
            "[nodes.fuse]\nkind = 'fuse'\nconfig.receivers = [{{ tracker = 'bird' }}, {{ tracker = '{fused}' }}]\n"
        );
        let text = format!("[nodes.bird]\nkind = '{kind}'\ninstance = 'bird'\nconfig.{sensors}\n{fuse}");
        std::fs::write(&file, text).unwrap();
        let plan = Plan::load(&file, &[], KINDS).unwrap();
        let bird = plan.nodes.iter().find(|node| node.name == "bird").unwrap();
        (bird.gives.join(" "), plan.warnings.join("\n"))
    };
    let (gives, warnings) = given("tracker_flock", "sensors = [2, 3, 5]", "bird_3");
    assert_eq!((gives.as_str(), warnings.as_str()), ("tracker/bird/pose tracker/bird_3/pose tracker/bird_5/pose", ""));
    let (gives, warnings) = given("tracker_polhemus", "stations = [1, 2]", "bird_3");
    assert_eq!(gives, "tracker/bird/pose tracker/bird_2/pose");
    assert!(warnings.contains("fuse takes tracker/bird_3/pose, which no node of this rig gives"), "{warnings}");
}

#[test]
fn a_camera_and_a_tracker_that_stamp_by_different_clocks_are_named() {
    let warned = |file: &str, set: &[String]| Plan::load(&repository(file), set, KINDS).unwrap().warnings.join("\n");
    let forgotten = warned("launch/emulated.toml", &["flock.scan_clock=false".to_owned()]);
    assert!(forgotten.contains("set flock.scan_clock = true") && forgotten.contains("no picture"), "{forgotten}");
    let left_over = warned("launch/bench.toml", &["tracker.scan_clock=true".to_owned()]);
    assert!(left_over.contains("set tracker.scan_clock = false"), "{left_over}");
    assert!(!warned("launch/emulated.toml", &[]).contains("scan_clock"));
}

#[test]
fn what_cannot_be_played_is_refused_by_name() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let taken = file.path().to_str().unwrap();
    let cases: [(&str, &[&str], &str); 9] = [
        ("flock", &["--rate-hz", "145"], "--rate-hz 145"),
        ("flock", &["--first-sensor", "3", "--units", "2"], "--first-sensor 3"),
        ("flock", &["--metal", "128"], "--metal"),
        ("flock", &["--flip-every=-1"], "--flip-every -1"),
        ("flock", &["--cut-every", "5"], "--cut-for"),
        ("flock", &["--cut-every", "1", "--cut-for", "2"], "--cut-for 2"),
        ("flock", &["--link", taken], taken),
        ("polhemus", &["--family", "isotrak"], "fastrak, liberty or patriot"),
        ("polhemus", &["--family", "patriot", "--stations", "3"], "--stations 3"),
    ];
    for (device, arguments, named) in cases {
        let output = emulate(device).args(arguments).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains(named), "{arguments:?}: {said}");
        assert!(!said.contains("panicked"), "{said}");
    }
}
