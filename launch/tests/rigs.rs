//! Rigs of real processes on a real bus: started, watched, started again, and stopped whatever they do.

#![allow(clippy::unwrap_used, reason = "a helper that cannot go on has failed its test")]

use limn::board::{Event, Process};
use limn::launcher::{Launcher, Options};
use limn::log::Line;
use limn::nodes::KINDS;
use limn::operator::Order;
use limn::plan::Plan;
use limn::stop::Rung;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use tempfile::TempDir;

/// Nothing here takes so long unless it hangs.
const LONG: Duration = Duration::from_secs(60);

fn foreign_node() -> PathBuf {
    let limn = Path::new(env!("CARGO_BIN_EXE_limn"));
    limn.with_file_name("examples").join("foreign_node")
}

struct Rig {
    launcher: Launcher,
    lines: Arc<Mutex<Vec<Line>>>,
    _folder: TempDir,
}

async fn start(nodes: &str) -> anyhow::Result<Rig> {
    let folder = tempfile::tempdir()?;
    let file = folder.path().join("test.toml");
    std::fs::write(&file, nodes.replace("EXEC", &format!("exec = {:?}", foreign_node())))?;
    let plan = Plan::load(&file, &[], KINDS)?;
    let lines = Arc::<Mutex<Vec<Line>>>::default();
    let kept = lines.clone();
    let sink = Arc::new(move |line: &Line| kept.lock().unwrap().push(line.clone()));
    let options = Options { executable: env!("CARGO_BIN_EXE_limn").into(), machine: None, sink };
    Ok(Rig { launcher: Launcher::start(plan, options).await?, lines, _folder: folder })
}

fn is_alive(pid: u32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    stat.rsplit_once(')').is_some_and(|(_, state)| !state.trim_start().starts_with(['Z', 'X']))
}

fn pid(rig: &Rig, node: &str) -> u32 {
    match rig.launcher.status().nodes[node].process {
        Process::Running(pid) => pid,
        ref other => panic!("{node} does not run: {other:?}"),
    }
}

async fn within<T>(what: impl Future<Output = T>) -> T {
    tokio::time::timeout(LONG, what).await.expect("in time")
}

#[tokio::test(flavor = "multi_thread")]
async fn a_rig_gets_ready_finishes_its_scan_and_stops_when_its_lifelines_close() {
    let mut rig = start("[nodes.one]\nEXEC\n[nodes.two]\nEXEC\ninstance = 'two'\n").await.unwrap();
    within(rig.launcher.wait_ready()).await.unwrap();
    let mut events = rig.launcher.events();
    rig.launcher.order(Order::Both);
    rig.launcher.order(Order::End);
    within(rig.launcher.wait_ended()).await.unwrap();
    let mut finished = 0;
    while let Ok(event) = events.try_recv() {
        finished += usize::from(matches!(event, Event::Finished { scan: 1, .. }));
    }
    assert_eq!(finished, 2);
    assert!(within(rig.launcher.stop()).await <= Rung::Close);
    rig.launcher.check().unwrap();
    let lines = rig.lines.lock().unwrap();
    assert!(lines.iter().any(|line| line.node == "two" && line.text == "counted 0 pictures"), "{lines:?}");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_killed_node_is_started_again() {
    let mut rig = start("[nodes.one]\nEXEC\n").await.unwrap();
    within(rig.launcher.wait_ready()).await.unwrap();
    let first = pid(&rig, "one");
    let mut events = rig.launcher.events();
    kill(first);
    let reason = within(async {
        loop {
            if let Event::Restarting { reason, .. } = events.recv().await.unwrap() {
                break reason;
            }
        }
    })
    .await;
    assert!(reason.contains("signal: 9"), "{reason}");
    within(async { while !matches!(events.recv().await.unwrap(), Event::Ready { .. }) {} }).await;
    assert_ne!(pid(&rig, "one"), first);
    assert_eq!(rig.launcher.status().nodes["one"].restarts, 1);
    within(rig.launcher.stop()).await;
    rig.launcher.check().unwrap();
}

#[tokio::test(flavor = "multi_thread")]
async fn a_required_node_that_fails_for_good_fails_the_rig_and_another_does_not() {
    let text = "[nodes.must]\nEXEC\nconfig.fail = true\nrestart = 'never'\n\
                [nodes.may]\nEXEC\ninstance = 'may'\nrequired = false\nrestart = 'never'\nconfig.fail = true\n";
    let mut rig = start(text).await.unwrap();
    let error = within(rig.launcher.wait_ready()).await.unwrap_err().to_string();
    assert!(error.contains("must failed: told to fail (exit status: 3)"), "{error}");
    within(rig.launcher.stop()).await;
    assert!(rig.launcher.check().is_err());
    let mut rig = start("[nodes.may]\nEXEC\nrequired = false\nrestart = 'never'\nconfig.fail = true\n").await.unwrap();
    within(rig.launcher.wait_gone()).await.unwrap();
    within(rig.launcher.stop()).await;
    rig.launcher.check().unwrap();
}

#[tokio::test(flavor = "multi_thread")]
async fn a_node_that_is_never_ready_is_named() {
    let rig = start("[run]\nready_s = 0.2\n[nodes.mute]\nexec = '/bin/cat'\nargs = ['-']\n").await;
    let mut rig = rig.unwrap();
    let error = match rig.launcher.wait_ready().await {
        Ok(()) => panic!("cat is no node"),
        Err(error) => error.to_string(),
    };
    assert!(error.contains("mute"), "{error}");
    within(rig.launcher.stop()).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_node_that_does_not_listen_is_terminated_and_one_that_cannot_is_killed() {
    let times = "[run]\nclose_s = 0.2\nterm_s = 0.2\n";
    let mut rig = start(&format!("{times}[nodes.deaf]\nEXEC\nconfig.deaf = true\n")).await.unwrap();
    within(rig.launcher.wait_ready()).await.unwrap();
    let deaf = pid(&rig, "deaf");
    assert_eq!(within(rig.launcher.stop()).await, Rung::Term);
    assert!(!is_alive(deaf));
    rig.launcher.check().unwrap();

    let stubborn = "[nodes.stubborn]\nexec = '/bin/sh'\nargs = ['-c', 'trap \"\" TERM; while :; do sleep 1; done']\n";
    let mut rig = start(&format!("{times}{stubborn}")).await.unwrap();
    let mut status = rig.launcher.status();
    while !matches!(status.nodes["stubborn"].process, Process::Running(_)) {
        tokio::task::yield_now().await;
        status = rig.launcher.status();
    }
    let stubborn = pid(&rig, "stubborn");
    let rung = within(rig.launcher.stop()).await;
    assert!(rung >= Rung::Term, "{rung:?}");
    assert!(!is_alive(stubborn));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_launcher_that_is_dropped_takes_its_nodes_along() {
    let rig = start("[nodes.deaf]\nEXEC\nconfig.deaf = true\n").await.unwrap();
    within(rig.launcher.wait_ready()).await.unwrap();
    let deaf = pid(&rig, "deaf");
    drop(rig);
    within(async {
        while is_alive(deaf) {
            tokio::time::sleep(Duration::from_millis(10)).await;
        }
    })
    .await;
}

#[tokio::test(flavor = "multi_thread")]
async fn a_port_in_use_is_named() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let endpoint = taken.local_addr().unwrap();
    let refused = start(&format!("[bus]\nendpoint = '{endpoint}'\n[nodes.one]\nEXEC\n")).await;
    let Err(error) = refused else { panic!("two listen on {endpoint}") };
    assert!(format!("{error:#}").contains(&format!("is {endpoint} in use already?")), "{error:#}");
}

fn kill(pid: u32) {
    let done = std::process::Command::new("kill").args(["-9", &pid.to_string()]).status().unwrap();
    assert!(done.success());
}
