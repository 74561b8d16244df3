//! The command line, as a person meets it.

#![allow(clippy::unwrap_used, reason = "a helper that cannot go on has failed its test")]

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Nothing here takes so long unless it hangs.
const LONG: Duration = Duration::from_secs(60);

struct Desk(TempDir);

impl Desk {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("run")).unwrap();
        let node = Path::new(env!("CARGO_BIN_EXE_limn")).with_file_name("examples").join("foreign_node");
        for (name, text) in files {
            let text = text.replace("EXEC", &format!("exec = {node:?}"));
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// A command that sees no rig but those of this test.
    fn limn(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_limn"));
        command.args(args).current_dir(self.0.path()).env("XDG_RUNTIME_DIR", self.path("run")).stdin(Stdio::null());
        command
    }

    fn run(&self, args: &[&str]) -> Output {
        self.limn(args).output().unwrap()
    }

    fn refusal(&self, args: &[&str]) -> String {
        let output = self.run(args);
        assert!(!output.status.success(), "{args:?} was not refused");
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!error.contains("panicked"), "{error}");
        error
    }

    fn success(&self, args: &[&str]) -> String {
        let output = self.run(args);
        assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    }
}

/// `limn up`, with its log.
struct Up {
    child: Child,
    log: BufReader<std::process::ChildStderr>,
}

impl Up {
    fn start(desk: &Desk, args: &[&str]) -> Self {
        let mut child = desk.limn(args).stderr(Stdio::piped()).spawn().unwrap();
        let log = BufReader::new(child.stderr.take().unwrap());
        Self { child, log }
    }

    fn wait_for(&mut self, wanted: &str) -> String {
        let mut seen = String::new();
        loop {
            let mut line = String::new();
            assert!(self.log.read_line(&mut line).unwrap() > 0, "{wanted:?} never came in\n{seen}");
            if line.contains(wanted) {
                return line;
            }
            seen.push_str(&line);
        }
    }

    fn signal(&self, signal: &str) {
        let sent = Command::new("kill").args([signal, &self.child.id().to_string()]).status().unwrap();
        assert!(sent.success());
    }
}

impl Drop for Up {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

const TWO: &str = "[nodes.one]\nEXEC\n[nodes.two]\nEXEC\n";

#[test]
fn a_rig_that_is_up_obeys_the_operator_and_stops_at_an_interrupt() {
    let desk = Desk::new(&[("rig.toml", TWO)]);
    let mut up = Up::start(&desk, &["up", "rig.toml"]);
    up.wait_for("one is ready");
    assert!(desk.success(&["scan", "both"]).contains("rig rig, scan 1: Both"));
    assert!(desk.success(&["scan", "end"]).contains("scan 1: End"));
    up.wait_for("has finished scan 1");
    assert!(desk.success(&["scan", "shape"]).contains("scan 2: Shape"));
    assert!(desk.success(&["scan", "discard"]).contains("scan 3: Aim"));
    assert!(desk.success(&["echo", "run/phase", "-n", "1"]).contains("scan: 3"));
    assert!(desk.success(&["hz", "@health/**", "-n", "3"]).contains("@health/one/head"));
    assert!(desk.success(&["topics"]).contains("run/phase"));
    assert!(desk.refusal(&["up", "rig.toml"]).contains("a rig \"rig\" is up already"));
    up.signal("-INT");
    assert!(up.child.wait().unwrap().success());
    assert!(desk.refusal(&["scan", "end"]).contains("no rig is up"));
}

#[test]
fn a_rig_that_runs_once_ends_by_itself() {
    let desk = Desk::new(&[("rig.toml", TWO)]);
    let mut up = Up::start(&desk, &["up", "rig.toml", "--set", "run.once=true", "--set", "run.begin=both"]);
    up.wait_for("scan 1: Both");
    desk.success(&["scan", "end"]);
    assert!(up.child.wait().unwrap().success());
}

#[test]
fn a_node_that_fails_for_good_shows_in_the_exit_status() {
    let desk = Desk::new(&[("rig.toml", "[nodes.bad]\nEXEC\nrestart = 'never'\nconfig.fail = true\n")]);
    let error = desk.refusal(&["up", "rig.toml"]);
    assert!(error.contains("bad | ERROR told to fail") && error.contains("bad failed: told to fail"), "{error}");
}

#[test]
fn killing_the_launcher_leaves_no_process() {
    let desk = Desk::new(&[("rig.toml", TWO)]);
    let mut up = Up::start(&desk, &["up", "rig.toml"]);
    up.wait_for("two is ready");
    let nodes = children(up.child.id());
    assert_eq!(nodes.len(), 2, "{nodes:?}");
    up.signal("-KILL");
    up.child.wait().unwrap();
    let started = Instant::now();
    while nodes.iter().any(|&pid| is_alive(pid)) {
        assert!(started.elapsed() < LONG, "{nodes:?} live on");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(desk.refusal(&["scan", "end"]).contains("no rig is up"), "what it left behind is cleared away");
}

#[test]
fn bad_input_is_refused_with_its_place() {
    let desk = Desk::new(&[
        ("rig.toml", "[nodes.one]\nEXEC\nreqired = true\n"),
        ("noise.ply", "ply\nformat"),
        ("x.png", "no"),
    ]);
    assert!(desk.refusal(&["config", "rig.toml"]).contains("rig.toml:3: unknown key \"reqired\""));
    assert!(desk.refusal(&["up", "gone.toml"]).contains("gone.toml"));
    assert!(desk.refusal(&["node", "stirpe"]).contains("did you mean \"stripe\"?"));
    assert!(desk.refusal(&["node", "stripe"]).contains("one line of JSON"));
    assert!(desk.refusal(&["echo", "a"]).contains("no rig is up on this machine: start one with `limn up FILE`"));
    assert!(desk.refusal(&["surface", "noise.ply", "-o", "out.ply"]).contains("noise.ply"));
    assert!(desk.refusal(&["surface", "noise.ply", "-o", "out.doc"]).contains("say ply, stl, obj or glb"));
    assert!(desk.refusal(&["cluster", "gone.ply", "-o", "out.ply"]).contains("gone.ply"));
    assert!(desk.refusal(&["cluster", "gone.ply", "-o", "o.ply", "--set", "bal_radius_m=1"]).contains("ball_radius_m"));
    assert!(desk.refusal(&["stripe", "x.png"]).contains("x.png"));
    assert!(desk.refusal(&["compare", "noise.ply", "noise.ply"]).contains("noise.ply"));
}

#[test]
fn graph_and_config_print_what_stands_in_the_file() {
    let desk = Desk::new(&[("rig.toml", "[nodes.a]\nEXEC\ngives = ['x/y']\n[nodes.b]\nEXEC\ntakes = ['x/*']\n")]);
    assert!(desk.success(&["graph", "rig.toml"]).contains("x/y -> b"));
    assert!(desk.success(&["graph", "rig.toml", "--dot"]).contains("\"a\" -> \"b\""));
    let config = desk.success(&["config", "rig.toml", "--set", "run.pace=fast"]);
    assert!(config.contains("# rig.toml:3") && config.contains("# --set run.pace=fast"), "{config}");
}

#[test]
fn every_command_explains_itself() {
    let desk = Desk::new(&[]);
    let help = desk.success(&["--help"]);
    for command in [
        "up", "scan", "top", "topics", "echo", "hz", "graph", "config", "stripe", "cluster", "surface", "compare",
        "node", "demo", "model", "refine", "record", "replay", "emulate", "devices",
    ] {
        assert!(help.contains(&format!("  {command} ")), "{command} is not in the help");
        assert!(desk.success(&[command, "--help"]).len() > 100, "{command}");
    }
    assert!(desk.success(&["up", "--help"]).contains("limn up launch/demo.toml"));
}

/// Whatever is plugged into the machine that tests: the listing itself is tested on machines that are folders.
#[test]
fn devices_lists_what_is_plugged_in() {
    let page = Desk::new(&[]).success(&["devices"]);
    let links = |folder: &str| std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let cameras = links("/dev/v4l/by-id").count();
    assert_eq!(page.contains("No camera."), !page.contains("Camera "), "{page}");
    assert!(cameras == 0 || page.contains("/dev/v4l/by-id/"), "{page}");
    for adapter in links("/dev/serial/by-id") {
        assert!(page.contains(&adapter.display().to_string()), "{page}");
    }
    assert_eq!(page.contains("No serial port."), !page.contains("Serial port "), "{page}");
}

#[test]
fn a_cloud_goes_through_the_stages_on_files() {
    use std::fmt::Write as _;
    let mut dome = String::new();
    for k in 0..20_000 {
        let (z, turn) = (k as f64 / 20_000.0, 2.399_963 * k as f64);
        let across = (1.0 - z * z).sqrt();
        let n = [across * turn.cos(), across * turn.sin(), z];
        let p = n.map(|x| 20.0 * x);
        writeln!(dome, "{} {} {} {} {} {}", p[0], p[1], p[2], n[0], n[1], n[2]).unwrap();
    }
    let desk = Desk::new(&[("dome.xyz", &dome)]);
    let cluster = [
        "cluster",
        "dome.xyz",
        "--unit",
        "mm",
        "-o",
        "cloud.ply",
        "--set",
        "ball_radius_m=0.0004",
        "--set",
        "least_points=1",
    ];
    desk.success(&cluster);
    desk.success(&["surface", "cloud.ply", "-o", "mesh.ply"]);
    desk.success(&["surface", "dome.xyz", "--unit", "mm", "-o", "truth.stl"]);
    let table = desk.success(&["compare", "mesh.ply", "truth.stl", "--align"]);
    assert!(table.contains("model to truth"), "{table}");
    let json: serde_json::Value =
        serde_json::from_str(&desk.success(&["compare", "mesh.ply", "truth.stl", "--json"])).unwrap();
    let rms = json["model_to_truth"]["rms_mm"].as_f64().unwrap();
    assert!(rms < 0.1, "{rms} mm");
}

fn children(parent: u32) -> Vec<u32> {
    let of = |pid: &u32| {
        let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
        stat.rsplit_once(')').and_then(|(_, rest)| rest.split_whitespace().nth(1)?.parse().ok()) == Some(parent)
    };
    let all = std::fs::read_dir("/proc").unwrap().filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok());
    all.filter(of).collect()
}

fn is_alive(pid: u32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    stat.rsplit_once(')').is_some_and(|(_, state)| !state.trim_start().starts_with(['Z', 'X']))
}
