//! Whole rigs as real processes on a real bus: what the tests in `tests/` share.

pub mod emulated;
pub mod rig;
pub mod terminal;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The program under test, beside the test that runs: `cargo test --workspace` builds both.
///
/// # Panics
/// When it has not been built.
pub fn limn() -> Command {
    let beside = std::env::current_exe().ok().and_then(|test| Some(test.parent()?.parent()?.join("limn")));
    match beside.filter(|path| path.is_file()) {
        Some(path) => Command::new(path),
        None => panic!("the program limn is not built: run `cargo test --workspace`"),
    }
}

/// A file of the project.
pub fn repository(path: &str) -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    root.canonicalize().unwrap_or(root).join(path)
}

/// `limn demo` without a page, on a sweep that takes a few seconds.
pub fn short_demo(out: &Path) -> Command {
    let mut demo = limn();
    demo.args(["demo", "--headless", "--seconds", "6", "--rig"]).arg(quick_rig(out)).arg("--out").arg(out);
    demo
}

/// A handset that is simulated in no time and measures well: the paper's camera, the fine rig's tracker.
///
/// # Panics
/// When the project's rigs cannot be read, or the folder cannot be written to.
pub fn quick_rig(out: &Path) -> PathBuf {
    let rig = |name: &str| -> anyhow::Result<toml::Table> {
        Ok(std::fs::read_to_string(repository(&format!("config/rigs/{name}.toml")))?.parse()?)
    };
    let write = || -> anyhow::Result<PathBuf> {
        let (mut quick, mut fine) = (rig("paper")?, rig("fine")?);
        let tracker = fine["simulation"]["tracker"].clone();
        quick["simulation"]["tracker"] = tracker;
        quick.extend(fine.remove_entry("clock"));
        std::fs::create_dir_all(out)?;
        let path = out.join("quick.toml");
        std::fs::write(&path, toml::to_string(&quick)?)?;
        Ok(path)
    };
    match write() {
        Ok(path) => path,
        Err(error) => panic!("the rig of the tests: {error:#}"),
    }
}

/// The same scan by `limn up`, which ends when it is done.
pub fn short_up(out: &Path) -> Command {
    let mut up = limn();
    up.arg("up").arg(repository("launch/demo.toml"));
    short_sets(&mut up, out);
    up
}

/// What makes a launch file that includes the demo's a short scan into a folder.
pub fn short_sets(up: &mut Command, out: &Path) {
    let rig = quick_rig(out);
    let (export, record) = (format!("export.folder={out:?}"), format!("record.file={:?}", out.join("scan.mcap")));
    let rigs = ["rig.file", "camera.rig", "tracker.rig"].map(|key| format!("{key}={rig:?}"));
    let others = ["run.pace=fast", "nodes.view.enabled=false", "camera.seconds=6.0", "tracker.seconds=6.0"];
    for set in others.map(str::to_owned).iter().chain(&rigs).chain([&export, &record]) {
        up.args(["--set", set]);
    }
}

/// What a scan of a few seconds is made with where its decimals count: refinement hears the last one of a pose, and such a
/// scan gives it little to hold on to.
pub const UNREFINED: [&str; 6] = [
    "--set",
    "nodes.refine.enabled=false",
    "--set",
    "nodes.cluster.inputs.world=head",
    "--set",
    "nodes.paint.inputs.world=head",
];

/// A number of a report, by its path.
///
/// # Panics
/// When it is not there.
pub fn number(report: &serde_json::Value, path: &str) -> f64 {
    match report.pointer(path).and_then(serde_json::Value::as_f64) {
        Some(number) => number,
        None => panic!("{path} is not in {report:#}"),
    }
}

/// Fails unless a file has the same bytes in both folders.
///
/// # Panics
/// When it has not.
pub fn same_bytes(a: &Path, b: &Path, file: &str) {
    let read = |folder: &Path| match std::fs::read(folder.join(file)) {
        Ok(bytes) => bytes,
        Err(error) => panic!("{}: {error}", folder.join(file).display()),
    };
    assert!(read(a) == read(b), "{file} differs between {} and {}", a.display(), b.display());
}

/// Messages lost, on all inputs of all nodes.
pub fn lost(report: &serde_json::Value) -> u64 {
    report["stages"].as_array().into_iter().flatten().filter_map(|stage| stage["lost"].as_u64()).sum()
}

/// Runs it to its end, and fails with all that it said unless it succeeded.
///
/// # Panics
/// When it fails.
pub fn succeed(command: &mut Command) -> Output {
    match command.output() {
        Ok(output) if output.status.success() => output,
        Ok(output) => panic!(
            "{command:?} failed with {}\n{}\n{}",
            output.status,
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        ),
        Err(error) => panic!("{command:?}: {error}"),
    }
}

/// The numbers of a run.
///
/// # Panics
/// When there are none.
pub fn report(out: &Path) -> serde_json::Value {
    let path = out.join("report.json");
    match std::fs::read(&path).map_err(anyhow::Error::from).and_then(|text| Ok(serde_json::from_slice(&text)?)) {
        Ok(report) => report,
        Err(error) => panic!("{}: {error}", path.display()),
    }
}

/// Real data that is not part of the project, where there is some; says so where there is none.
pub fn shared_data(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(name);
    if !path.is_dir() {
        // Past the test harness, which keeps to itself what a green test prints.
        let _ = writeln!(std::io::stderr(), "SKIPPED: {} is not there, so nothing of it was tested", path.display());
        return None;
    }
    Some(path)
}
