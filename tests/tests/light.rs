//! The node of the lights on a bus, before a board that is played: the operator's word switches laser and lamp, and the end
//! of the node puts them out.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

#[path = "../../nodes/light/tests/harness/board.rs"]
mod board;

use board::Board;
use bus::{Bus, BusConfig, Router};
use kit::{Node, NodeSpec};
use serial_line::{FaultsConfig, HostClock, Pty};
use system_tests::rig::{wait_on, wait_until};
use wire::{Clock, Header, Phase, RunPhase, topic};

const DARK: [bool; 2] = [false, false];
const LASER: [bool; 2] = [true, false];
const LAMP: [bool; 2] = [false, true];

#[test]
fn the_operators_word_switches_the_lights_and_the_nodes_end_puts_them_out() {
    let router = Router::start(&BusConfig::default()).unwrap();
    let place = BusConfig { endpoint: router.endpoint().to_owned(), ..BusConfig::default() };
    let operator = Bus::open(&place).unwrap();
    let mut phases = operator.publisher(&topic::run_phase()).unwrap();
    let mut say = |phase| {
        let header = Header { scan: 1, phase, clock: Clock::System, ..Header::default() };
        phases.send(RunPhase { header, discard: false }).unwrap();
    };
    let folder = tempfile::tempdir().unwrap();
    let port = folder.path().join("lights");
    let config = serde_json::json!({ "port": port, "laser_ms": 60, "lamp_ms": 30 });
    let node = Node::open_unattended(NodeSpec { config, ..NodeSpec::new("light", "head", place) }).unwrap();
    let stopper = node.stopper();
    let mut lines = operator.subscribe(&topic::log("light/head"), 64).unwrap();
    let at_work = std::thread::spawn(move || light::node::run(node));

    // What is missing is named on the bus, and the rig is not kept waiting for it.
    wait_on(&operator, "what is missing is not named", || {
        std::iter::from_fn(|| lines.next()).find(|line| line.text.contains("there is no"))
    });
    let board = Pty::start(Board::default(), FaultsConfig::default(), HostClock::start(), Some(&port)).unwrap();
    for (phase, on) in [(Phase::Aim, LASER), (Phase::Shape, LASER), (Phase::Colour, LAMP), (Phase::End, DARK)] {
        say(phase);
        wait_until(&format!("{phase:?}"), || board.device().on == on);
    }
    say(Phase::Both);
    wait_until("they do not take turns", || {
        let states = &board.device().states;
        [LASER, LAMP].iter().all(|light| states.iter().rev().take(6).filter(|on| *on == light).count() == 3)
    });
    assert!(!board.device().states.contains(&[true, true]), "never both at once");
    say(Phase::Shape);
    wait_until("the laser", || board.device().on == LASER);
    stopper.stop();
    at_work.join().unwrap().unwrap();
    assert_eq!(board.device().on, DARK);
}
