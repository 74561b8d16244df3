//! rig.toml from anywhere: read or refused, never a panic; what is read can measure.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use geometry::{Rig, rigid_from_wire};
use proptest::prelude::*;

const PAPER: &str = include_str!("../../../config/rigs/paper.toml");
/// What a person, or a program of theirs, may write for a number.
const VALUES: &[&str] = &[
    "0",
    "-1",
    "1",
    "-0.0",
    "1e-300",
    "1e300",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "4294967296",
    "9223372036854775807",
    "\"x\"",
    "true",
    "[]",
    "[1.0]",
    "{}",
    "",
];

/// Places of the numbers of a text.
fn numbers(text: &str) -> Vec<std::ops::Range<usize>> {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-');
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) = text[at..].find(is_part).map(|k| at + k) {
        let length = text[start..].find(|c| !is_part(c)).unwrap_or(text.len() - start);
        found.push(start..start + length);
        at = start + length;
    }
    found
}

/// The rig can be published, and what comes out is a handset.
fn reads_or_refuses(text: &str) {
    let Ok(rig) = Rig::parse(text) else { return };
    let calibration = rig.calibration().unwrap();
    assert!(rigid_from_wire(&calibration.body_from_camera).is_some(), "{text}");
    let normal = calibration.laser.normal.map(|n| n * n).iter().sum::<f64>();
    assert!((normal - 1.0).abs() < 1e-9 && calibration.laser.distance_m.is_finite(), "{text}");
    assert!(Rig::from_calibration(&calibration).is_ok(), "{text}");
}

proptest! {
    #[test]
    fn any_text(text in ".{0,200}") {
        reads_or_refuses(&text);
    }

    #[test]
    fn a_rig_with_a_few_numbers_changed(
        changes in prop::collection::vec((any::<prop::sample::Index>(), prop::sample::select(VALUES)), 1..3),
    ) {
        let mut text = PAPER.split("[simulation").next().unwrap().to_owned();
        for (which, value) in changes {
            let places = numbers(&text);
            text.replace_range(places[which.index(places.len())].clone(), value);
        }
        reads_or_refuses(&text);
    }

    #[test]
    fn a_rig_with_a_line_gone_or_twice(which: prop::sample::Index, twice: bool) {
        let mut lines: Vec<&str> = PAPER.lines().collect();
        let at = which.index(lines.len());
        let line = lines.remove(at);
        if twice {
            lines.splice(at..at, [line, line]);
        }
        reads_or_refuses(&lines.join("\n"));
    }
}

#[test]
fn the_rig_as_it_is_is_read_and_a_sheet_through_the_camera_is_not_however_long_its_normal() {
    assert!(Rig::parse(PAPER).is_ok());
    let long = PAPER.replace("[-0.894398213,", "[4294967296,");
    assert!(long != PAPER && Rig::parse(&long).is_err());
}
