//! All that the driver says to a flock from the opening of the port to the stream, byte for byte, as the manual's tables of
//! commands and parameters have it: written down here by hand, and heard by a wire-tap before the flock that is played.

#![cfg(feature = "serial")]
#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

#[path = "../../serial_line/tests/harness/listener.rs"]
#[allow(dead_code, reason = "only its poses are wanted here")]
mod harness;

use harness::Listener;
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{Emulated, FaultsConfig, HostClock, Pty};
use tracker_flock::emulator::{EmulatorConfig, FlockEmulator, World};
use tracker_flock::port::Flock;
use tracker_flock::protocol::reading::Scale;
use tracker_flock::protocol::records::Format;
use tracker_flock::{Config, FlockTracker, Hemisphere};

/// Writes down what the flock hears.
struct Tapped {
    flock: FlockEmulator,
    heard: Vec<u8>,
}

impl Emulated for Tapped {
    fn hear(&mut self, bytes: &[u8], now_nanos: i64) {
        self.heard.extend(bytes);
        self.flock.hear(bytes, now_nanos);
    }

    fn speak(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)> {
        self.flock.speak(now_nanos)
    }
}

/// What the flock has heard when its first records have come, and how its units were set.
fn heard(config: Config, units: u8) -> (String, Vec<[u8; 2]>) {
    let world: World = Box::new(|_, _| (Vector3::new(0.3, 0.2, 0.1), UnitQuaternion::from_euler_angles(0.3, 0.4, 0.5)));
    let flock = FlockEmulator::new(EmulatorConfig { units, ..EmulatorConfig::default() }, world);
    let clock = HostClock::start();
    let pty = Pty::start(Tapped { flock, heard: Vec::new() }, FaultsConfig::default(), clock, None).unwrap();
    let config = Config { port: pty.path().to_owned(), ..config };
    let flock = Flock::new(config.clone());
    let line = flock.line_settings();
    Listener::start(flock, line, FlockTracker::new(config).unwrap(), clock).poses(2);
    let device = pty.device();
    let bytes = device.heard.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(" ");
    (bytes, device.flock.settings().iter().map(|unit| unit.3).collect())
}

fn golden(parts: &[&str]) -> String {
    parts.join(" ")
}

#[test]
fn the_set_up_of_a_bird_alone_is_a_list_of_bytes() {
    let expected = golden(&[
        "11 42",                                           // XON, POINT: ends a stream
        "4F 00 4F 0F 4F 01 4F 0A",                         // EXAMINE status, model, revision, error
        "46",                                              // RUN
        "50 07 00 67",                                     // CHANGE rate: 103 x 256
        "50 14 32",                                        // line frequency 50 Hz
        "50 03 00 00",                                     // scale 36 inches
        "50 04 02 00",                                     // filters: AC wide off
        "50 0C 02 00 02 00 02 00 0A 00 0A 00 28 00 C8 00", // Vm 2 2 2 10 10 40 200
        "50 0E 00",                                        // no sudden-change lock
        "4C 00 00",                                        // hemisphere forward
        "73 00 00",                                        // no metal
        "4F 0A",                                           // EXAMINE error
        "5A",                                              // POSITION/MATRIX
        "51 40",                                           // every cycle, STREAM
    ]);
    assert_eq!(heard(Config::default(), 0).0, expected);
}

#[test]
fn the_set_up_of_a_group_is_a_list_of_bytes() {
    let config = Config {
        sensors: vec![1, 2],
        output: Format::PositionAngles,
        hemisphere: Hemisphere::Lower,
        rate_hz: 100.0,
        line_frequency_hz: 60,
        scale_inches: Scale::Inches72,
        report_every: 2,
        ac_narrow_filter: false,
        dc_filter: false,
        dc_alpha_min: Some([0.02; 7]),
        dc_motion: None,
        dc_alpha_max: Some([0.9; 7]),
        sudden_change_lock: true,
        metal: true,
        ..Config::default()
    };
    let unit = |prefix: &str| {
        let alpha_min = "50 05".to_owned() + &" 8F 02".repeat(7);
        let alpha_max = "50 0D".to_owned() + &" 33 73".repeat(7);
        let settings =
            ["50 14 3C", "50 03 01 00", "50 04 07 00", &alpha_min, &alpha_max, "50 0E 01", "4C 0C 00", "73 01 00"];
        settings.map(|setting| format!("{prefix} {setting}")).join(" ")
    };
    let expected = golden(&[
        "11 42",
        "4F 00 4F 0F 4F 01 4F 0A",
        "50 23 00",          // group mode off
        "50 32 02",          // AUTO-CONFIG, two units
        "4F 13 4F 00 4F 24", // EXAMINE addressing, status, status of the flock
        "46",
        "50 07 00 64",
        &unit("F1"),
        &unit("F2"),
        "4F 0A",
        "F1 59 F2 59", // POSITION/ANGLES
        "50 23 01",    // group mode on
        "52 40",       // every second cycle, STREAM
    ]);
    assert_eq!(heard(config, 2).0, expected);
}

#[test]
fn each_half_of_space_has_the_manuals_bytes_and_is_understood() {
    for (hemisphere, bytes) in [
        (Hemisphere::Forward, [0x00, 0x00]),
        (Hemisphere::Aft, [0x00, 0x01]),
        (Hemisphere::Upper, [0x0C, 0x01]),
        (Hemisphere::Lower, [0x0C, 0x00]),
        (Hemisphere::Left, [0x06, 0x01]),
        (Hemisphere::Right, [0x06, 0x00]),
    ] {
        let (said, set) = heard(Config { hemisphere, ..Config::default() }, 0);
        assert!(said.contains(&format!("4C {:02X} {:02X}", bytes[0], bytes[1])), "{hemisphere:?}: {said}");
        assert_eq!(set, [bytes]);
    }
}

#[test]
fn the_report_rate_has_a_letter_each() {
    for (report_every, letter) in [(1, "51"), (2, "52"), (8, "53"), (32, "54")] {
        let (said, _) = heard(Config { report_every, rate_hz: 144.0, ..Config::default() }, 0);
        assert!(said.ends_with(&format!("5A {letter} 40")), "{report_every}: {said}");
    }
}
