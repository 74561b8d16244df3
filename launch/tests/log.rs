//! The log: levels found again, one name in front of each line.

use limn::backoff::{Backoff, MOST, WINDOW};
use limn::log::{Line, format, parse};
use proptest::prelude::*;
use std::time::{Duration, Instant};
use wire::LogLevel;

#[test]
fn lines_of_nodes_keep_their_level() {
    let line = parse("stripe", "ERROR no laser \n");
    assert_eq!(line, Line { node: "stripe".into(), level: LogLevel::Error, text: "no laser".into() });
    assert_eq!(parse("stripe", " INFO ready").text, "ready");
    assert_eq!(parse("sh", "INFORMATION is free").level, LogLevel::Info);
    assert_eq!(parse("sh", "INFORMATION is free").text, "INFORMATION is free");
    assert_eq!(parse("sh", "\x1b[2Jgone").text, "[2Jgone", "a node must not paint the terminal");
}

#[test]
fn the_name_stands_in_front() {
    let line = Line { node: "stripe".into(), level: LogLevel::Warn, text: "dim".into() };
    assert_eq!(format(&line, 8, false), "  stripe | WARN dim");
    assert!(format(&line, 8, true).contains("\x1b[33m"));
}

#[test]
fn a_node_that_fails_too_often_has_failed_for_good_and_old_failures_are_forgiven() {
    let (mut backoff, start) = (Backoff::default(), Instant::now());
    let pauses: Vec<Duration> = (0..MOST).map(|_| backoff.failed(start).unwrap()).collect();
    assert!(pauses.windows(2).all(|pair| pair[0] <= pair[1]), "{pauses:?}");
    assert_eq!(backoff.failed(start), None);
    assert_eq!(backoff.failed(start + WINDOW + Duration::from_secs(1)), Some(pauses[0]));
}

proptest! {
    #[test]
    fn whatever_a_node_writes_it_paints_nothing(written: String) {
        let line = parse("sh", &written);
        prop_assert!(line.text.chars().all(|c| !c.is_control() || c == '\t'));
        prop_assert!(line.text.len() <= written.len());
    }

    #[test]
    fn what_is_written_at_a_level_is_heard_at_it(
        (word, level) in prop::sample::select(vec![
            ("ERROR", LogLevel::Error),
            ("WARN", LogLevel::Warn),
            ("INFO", LogLevel::Info),
            ("DEBUG", LogLevel::Debug),
            ("TRACE", LogLevel::Debug),
        ]),
        text in "[ -~]{0,60}",
    ) {
        let line = parse("stripe", &format!("  {word} x{text}"));
        prop_assert_eq!((line.level, line.text), (level, format!("x{text}").trim_end().to_owned()));
    }
}
