//! The lights, played behind a pseudo-terminal.

#![cfg(feature = "serial")]
#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

#[path = "harness/board.rs"]
mod board;

use board::Board;
use light::protocol::Dialect;
use light::{Config, Lights};
use serial_line::{FaultsConfig, HostClock, News, Pty};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};
use wire::Phase;

const LONG: Duration = Duration::from_secs(20);

fn plugged(board: Board, link: Option<&std::path::Path>) -> Pty<Board> {
    Pty::start(board, FaultsConfig::default(), HostClock::start(), link).unwrap()
}

fn start(config: Config) -> (Lights, Receiver<News>) {
    let (say, news) = channel();
    (Lights::start(config, move |n| drop(say.send(n))), news)
}

fn until(what: &str, reached: impl Fn() -> bool) {
    let started = Instant::now();
    while !reached() {
        assert!(started.elapsed() < LONG, "{what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn trouble(news: &Receiver<News>) -> String {
    loop {
        if let News::Trouble(trouble) = news.recv_timeout(LONG).unwrap() {
            return trouble.to_string();
        }
    }
}

#[test]
fn phases_switch_the_lights_of_both_dialects_and_the_end_puts_them_out() {
    for dialect in [Dialect::Limn, Dialect::Horus] {
        let pty = plugged(Board { horus: dialect == Dialect::Horus, ..Board::default() }, None);
        let port = pty.path().to_owned();
        let config = Config { port, dialect, laser_ms: 40, lamp_ms: 20, horus_lamp: Some(2), ..Config::default() };
        let (lights, news) = start(config);
        assert!(matches!(news.recv_timeout(LONG).unwrap(), News::Streaming(_)));
        lights.begin(Phase::Shape);
        until("the laser", || pty.device().on == [true, false]);
        lights.begin(Phase::Colour);
        until("the lamp", || pty.device().on == [false, true]);
        pty.device().states.clear();
        lights.begin(Phase::Both);
        until("turns", || pty.device().states.len() > 12);
        assert!(pty.device().states.iter().all(|on| *on != [true, true]), "{:?}", pty.device().states);
        lights.begin(Phase::Shape);
        drop(lights);
        assert_eq!(pty.device().on, [false, false], "{dialect:?}");
    }
}

#[test]
fn lights_that_are_not_there_and_then_are_and_then_are_deaf_are_named_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("lights");
    let (lights, news) = start(Config { port: link.clone(), ..Config::default() });
    lights.begin(Phase::Shape);
    assert!(trouble(&news).contains("there is no"));
    let pty = plugged(Board::default(), Some(&link));
    until("the laser", || pty.device().on == [true, false]);
    pty.device().deaf = true;
    let text = trouble(&news);
    assert!(text.contains("nothing answers") && text.contains("docs/hardware.md"), "{text}");
    drop(pty);
    let pty = plugged(Board::default(), Some(&link));
    until("the laser again", || pty.device().on == [true, false]);
    drop(lights);
}

#[test]
fn a_board_of_the_other_dialect_is_named() {
    let pty = plugged(Board::default(), None);
    let (_lights, news) = start(Config { port: pty.path().to_owned(), dialect: Dialect::Horus, ..Config::default() });
    let text = trouble(&news);
    assert!(text.contains("dialect"), "{text}");
}
