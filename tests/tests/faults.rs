//! What happens when processes die.

use std::process::Stdio;
use system_tests::limn;
use system_tests::rig::{Rig, children, is_alive, signal, wait_until};

#[test]
fn a_launcher_that_is_killed_leaves_no_process_behind() -> std::io::Result<()> {
    let folder = tempfile::tempdir()?;
    let mut demo = limn();
    demo.args(["demo", "--headless", "--pace", "real", "--seconds", "60", "--rig", "paper", "--out"]);
    let launcher = Rig::start(demo.arg(folder.path()).stdin(Stdio::null()));
    const NODES: usize = 10;
    wait_until("the nodes do not start", || children(launcher.pid()).len() >= NODES);
    let nodes = children(launcher.pid());
    signal(launcher.pid(), "KILL");
    let (status, _) = launcher.end();
    assert!(!status.success());
    wait_until("a node outlives its launcher", || nodes.iter().all(|pid| !is_alive(*pid)));
    Ok(())
}
