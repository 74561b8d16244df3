//! Lines and answers of both dialects.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use light::protocol::{Answer, Answers, Dialect, greeting, switch};
use light::{Config, DARK, lit};
use proptest::prelude::*;
use std::time::Duration;
use wire::{Light, Phase};

const LASER: Light = Light { laser: true, lamp: false };
const LAMP: Light = Light { laser: false, lamp: true };

fn answers(dialect: Dialect, bytes: &[u8]) -> Vec<Answer> {
    let mut answers = Answers::new(dialect);
    bytes.iter().filter_map(|byte| answers.push(*byte)).collect()
}

#[test]
fn both_dialects_switch_and_are_understood() {
    let limn = Config::default();
    assert_eq!(switch(&limn, LASER), ["light 1 0\n"]);
    assert_eq!(switch(&limn, LAMP), ["light 0 1\n"]);
    let horus = Config { dialect: Dialect::Horus, horus_lamp: Some(2), ..Config::default() };
    assert_eq!(switch(&horus, LASER), ["M70T2\r\n", "M71T1\r\n"], "what goes out goes out first");
    assert_eq!(switch(&horus, LAMP), ["M70T1\r\n", "M71T2\r\n"]);
    assert_eq!(switch(&Config { horus_lamp: None, ..horus }, LAMP), ["M70T1\r\n"]);
    assert_eq!(greeting(Dialect::Horus), b"\x18\r\n");
    let heard = answers(Dialect::Limn, b"? \r\nlimn-light 1\r\nok 1 0\nok 2 0\nok\n");
    assert_eq!(
        heard,
        [
            Answer::Refused("?".into()),
            Answer::Greeting("limn-light 1".into()),
            Answer::Done(Some(LASER)),
            Answer::Refused("ok 2 0".into()),
            Answer::Refused("ok".into()),
        ]
    );
    let heard = answers(Dialect::Horus, b"\r\nHorus 0.2 ['$' for help]\r\nok\r\nerror: Unsupported command\r\n");
    assert_eq!(
        heard,
        [
            Answer::Greeting("Horus 0.2 ['$' for help]".into()),
            Answer::Done(None),
            Answer::Refused("error: Unsupported command".into()),
        ]
    );
}

#[test]
fn each_phase_has_its_light() {
    let config = Config { laser_ms: 300, lamp_ms: 100, ..Config::default() };
    let at = |phase, millis| lit(&config, phase, Duration::from_millis(millis));
    for millis in [0, 299, 300, 5000] {
        assert_eq!(at(Phase::Shape, millis), LASER);
        assert_eq!(at(Phase::Colour, millis), LAMP);
        assert_eq!(at(Phase::End, millis), DARK);
        assert_eq!(at(Phase::Aim, millis), LASER);
    }
    let turns: Vec<bool> = (0..12).map(|k| at(Phase::Both, 100 * k).lamp).collect();
    assert_eq!(turns.iter().filter(|lamp| **lamp).count(), 3);
    assert_eq!(turns[..4], [false, false, false, true]);
    let no_laser = Config { aim_with_laser: false, ..config };
    assert_eq!(lit(&no_laser, Phase::Aim, Duration::ZERO), DARK);
}

#[test]
fn what_no_lights_can_do_is_refused_with_its_key() {
    Config::default().check().unwrap();
    let bad = [
        (Config { port: "".into(), ..Config::default() }, "port"),
        (Config { baud: 50, ..Config::default() }, "baud"),
        (Config { laser_ms: 0, ..Config::default() }, "laser_ms"),
        (Config { lamp_ms: 100_000, ..Config::default() }, "lamp_ms"),
        (Config { horus_laser: 3, ..Config::default() }, "horus_laser"),
        (Config { horus_lamp: Some(1), ..Config::default() }, "horus_lamp"),
    ];
    for (config, key) in bad {
        assert_eq!(config.check().unwrap_err().key, key);
    }
}

proptest! {
    #[test]
    fn any_garbage_is_survived_and_the_next_line_is_understood(
        bytes in proptest::collection::vec(any::<u8>(), 0..2000),
        horus in any::<bool>(),
    ) {
        let dialect = if horus { Dialect::Horus } else { Dialect::Limn };
        let mut answers = Answers::new(dialect);
        for byte in bytes {
            answers.push(byte);
        }
        let done = if horus { "\nok\n" } else { "\nok 0 1\n" };
        let last = done.bytes().filter_map(|byte| answers.push(byte)).last();
        prop_assert_eq!(last, Some(Answer::Done((!horus).then_some(LAMP))));
    }
}
