//! Somebody sits before it: keys, the table of nodes, and a demo with its page.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use kit::NodeSpec;
use std::collections::BTreeSet;
use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Command, Stdio};
use system_tests::rig::{Rig, children, is_alive, signal, wait_until};
use system_tests::terminal::Terminal;
use system_tests::{limn, lost, quick_rig, report, short_up};

/// A rig that waits for its operator.
fn aiming(out: &Path) -> Command {
    let mut up = short_up(out);
    up.args(["--set", "run.begin=aim", "--set", "run.once=false", "--set", "run.pace=real"]);
    up
}

#[test]
fn the_keys_of_limn_up_are_the_operators_commands() {
    let folder = tempfile::tempdir().unwrap();
    let terminal = Terminal::open();
    let mut up = terminal.start(aiming(folder.path()).env("XDG_RUNTIME_DIR", folder.path()));
    terminal.wait_for(&["keys: s shape", "export is ready"]);
    for (key, told) in [("s", "scan 1: Shape"), ("c", "scan 1: Colour"), ("B", "scan 1: Both")] {
        terminal.press(key);
        terminal.wait_for(&[told]);
    }
    // A key without a meaning has none.
    terminal.press("x?");
    terminal.press("e");
    terminal.wait_for(&["scan 1: Both", "scan 1: End"]);
    terminal.press("d");
    terminal.wait_for(&["scan 1: End", "scan 2: Aim"]);
    signal(up.pid(), "INT");
    assert!(up.ends_well(), "{}", terminal.shown());
}

#[test]
fn limn_top_shows_every_node_until_q() {
    let folder = tempfile::tempdir().unwrap();
    let mut rig = Rig::start(&mut aiming(folder.path()));
    drop(rig.bus());
    let terminal = Terminal::open();
    let mut top = terminal.start(limn().arg("top").env("XDG_RUNTIME_DIR", rig.runtime.path()));
    terminal.wait_for(&["rig demo", "p50 ms", "q ends"]);
    let nodes = ["camera_sim/head", "tracker_sim/head", "stripe/head", "refine/refined", "export/model"];
    wait_until("every node in the table", || {
        let screen = terminal.screen();
        nodes.iter().all(|node| screen.lines().any(|row| row.starts_with(node)))
    });
    assert!(top.runs(), "{}", terminal.shown());
    terminal.press("q");
    assert!(top.ends_well(), "{}", terminal.shown());
    signal(rig.pid(), "INT");
    let (status, said) = rig.end();
    assert!(status.success(), "{said}");
}

/// Where a process listens: address and port as /proc/net/tcp writes them (proc(5)), of the sockets that it holds.
fn listening(pid: u32) -> BTreeSet<String> {
    let held: BTreeSet<String> = std::fs::read_dir(format!("/proc/{pid}/fd"))
        .unwrap()
        .filter_map(|file| std::fs::read_link(file.ok()?.path()).ok()?.to_str().map(str::to_owned))
        .collect();
    let tables =
        ["tcp", "tcp6"].map(|table| std::fs::read_to_string(format!("/proc/{pid}/net/{table}")).unwrap_or_default());
    let fields =
        tables.iter().flat_map(|table| table.lines().skip(1)).map(|line| line.split_whitespace().collect::<Vec<_>>());
    const LISTEN: &str = "0A";
    fields
        .filter(|fields| fields[3] == LISTEN && held.contains(&format!("socket:[{}]", fields[9])))
        .map(|fields| fields[1].to_owned())
        .collect()
}

/// The first line of the answer to a browser's question.
fn ask(address: &str) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    write!(stream, "GET / HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    String::from_utf8_lossy(&answer).lines().next().unwrap_or_default().to_owned()
}

/// A viewer with a port of the page that somebody else has.
fn view_on(port: u16, rig: &mut Rig) -> String {
    let mut spec = NodeSpec::new("view", "late", rig.config());
    spec.config = serde_json::json!({ "web_port": port });
    let mut view = limn();
    view.args(["node", "view", "--instance", "late"]).stdin(Stdio::piped()).stderr(Stdio::piped());
    let mut view = view.spawn().unwrap();
    writeln!(view.stdin.as_mut().unwrap(), "{}", serde_json::to_string(&spec).unwrap()).unwrap();
    let output = view.wait_with_output().unwrap();
    assert!(!output.status.success());
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_demo_with_its_page_is_judged_first_and_stays_up_on_loopback_alone() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let terminal = Terminal::open();
    let mut demo = limn();
    demo.args(["demo", "--pace", "fast", "--seconds", "6", "--rig"]).arg(quick_rig(&out)).arg("--out").arg(&out);
    let mut demo = terminal.start(demo.env("XDG_RUNTIME_DIR", folder.path()));
    terminal.wait_for(&["look: http://127.0.0.1:", "messages lost", "report.html", "the page stays up until Ctrl-C"]);
    // All is there already.
    let told = report(&out);
    assert_eq!(lost(&told), 0);
    for file in ["truth.ply", "report.html", "model.glb"] {
        assert!(out.join(file).is_file(), "{file}");
    }
    let parts: Vec<&str> = told["times"].as_array().unwrap().iter().filter_map(|time| time["what"].as_str()).collect();
    let expected = ["start", "sweep", "refinement", "cloud", "surface", "colour", "files", "comparison", "all"];
    assert_eq!(parts, expected);

    let is_view = |pid: &u32| {
        std::fs::read_to_string(format!("/proc/{pid}/cmdline")).is_ok_and(|line| line.contains("\0node\0view\0"))
    };
    let view = children(demo.pid()).into_iter().find(is_view).expect("the viewer lives");
    let listening = listening(view);
    assert_eq!(listening.len(), 2, "the page and its data: {listening:?}");
    assert!(listening.iter().all(|address| address.starts_with("0100007F:")), "127.0.0.1 alone: {listening:?}");
    let shown = terminal.shown();
    let page = shown.split("look: http://").nth(1).and_then(|rest| rest.split('/').next()).unwrap();
    assert!(ask(page).contains("200"), "{page}: {}", ask(page));

    signal(demo.pid(), "INT");
    assert!(demo.ends_well(), "{}", terminal.shown());
    assert!(!is_alive(view));
}

#[test]
fn a_port_of_the_page_that_is_in_use_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut rig = Rig::start(&mut aiming(folder.path()));
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let said = view_on(port, &mut rig);
    assert!(said.contains(&format!("port {port} on 127.0.0.1 is in use")) && !said.contains("panicked"), "{said}");
    signal(rig.pid(), "INT");
    let (status, said) = rig.end();
    assert!(status.success(), "{said}");
}
