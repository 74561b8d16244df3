//! What happens when processes die.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};
use system_tests::limn;

const PATIENCE: Duration = Duration::from_secs(60);

/// Processes whose parent is `parent`: from /proc/PID/stat (proc(5), field 4).
fn children(parent: u32) -> BTreeSet<u32> {
    let processes = std::fs::read_dir("/proc").unwrap().flatten();
    let pids = processes.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    pids.filter(|pid| parent_of(*pid) == Some(parent)).collect()
}

fn parent_of(pid: u32) -> Option<u32> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    stat.rsplit_once(')')?.1.split_whitespace().nth(1)?.parse().ok()
}

fn is_alive(pid: u32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    stat.rsplit_once(") ").is_some_and(|(_, rest)| !rest.starts_with('Z'))
}

fn wait_until(what: &str, mut done: impl FnMut() -> bool) {
    let deadline = Instant::now() + PATIENCE;
    while !done() {
        assert!(Instant::now() < deadline, "{what}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

fn start_demo(out: &Path) -> Child {
    let mut demo = limn();
    demo.args(["demo", "--headless", "--pace", "real", "--seconds", "60", "--rig", "paper", "--out"]).arg(out);
    demo.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
}

#[test]
fn a_launcher_that_is_killed_leaves_no_process_behind() {
    let folder = tempfile::tempdir().unwrap();
    let mut launcher = start_demo(folder.path());
    const NODES: usize = 10;
    wait_until("the nodes do not start", || children(launcher.id()).len() >= NODES);
    let nodes = children(launcher.id());
    launcher.kill().unwrap();
    launcher.wait().unwrap();
    wait_until("a node outlives its launcher", || nodes.iter().all(|pid| !is_alive(*pid)));
}
