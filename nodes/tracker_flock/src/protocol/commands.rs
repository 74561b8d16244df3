//! What the host says (manual, chapters 5 to 7). Words of arguments are plain 16-bit numbers, low byte first.

use super::address::addressed;
use super::records::Format;
use crate::config::Config;
use crate::hemisphere::Hemisphere;
use serial_line::Step;
use std::time::Duration;

/// One record now; ends the stream. All units answer in group mode.
pub const POINT: u8 = b'B';
/// Records until told otherwise.
pub const STREAM: u8 = b'@';
/// Lets output flow that a stray XOFF holds.
pub const XON: u8 = 0x11;
/// EXAMINE: ask for a parameter.
pub const EXAMINE: u8 = b'O';
/// CHANGE: set a parameter.
pub const CHANGE: u8 = b'P';
/// Wakes a unit.
pub const RUN: u8 = b'F';
/// Puts a unit to sleep.
pub const SLEEP: u8 = b'G';
/// Which half of space is the sensor in.
pub const HEMISPHERE: u8 = b'L';
/// Chooses what a measure of metal is appended.
pub const METAL: u8 = b's';

/// The manual's wait before and after an auto-configuration (Revision B).
pub const CONFIGURATION_WAIT: Duration = Duration::from_millis(600);
/// Between two settings: a unit looks at its line once in a cycle.
const SETTING_WAIT: Duration = Duration::from_millis(30);

fn setting(about: &'static str, address: u8, command: &[u8]) -> Step {
    Step { about, send: addressed(address, command), wait: SETTING_WAIT }
}

/// Brings a flock of so many units to life: they do not measure before.
pub fn auto_configuration(units: u8) -> [Step; 2] {
    let wait = CONFIGURATION_WAIT;
    [
        Step { about: "rest before the auto-configuration", send: Vec::new(), wait },
        Step { about: "auto-configuration", send: vec![CHANGE, 50, units], wait },
    ]
}

/// Makes all units answer together, lowest address first, each record with its address.
pub fn group_mode(on: bool) -> Step {
    setting("group mode", 0, &[CHANGE, 35, u8::from(on)])
}

/// Chooses what a unit's records hold; ends the stream.
pub fn format(address: u8, format: Format) -> Step {
    setting("record format", address, &[format.command()])
}

/// All settings, unit for unit. The master's own have no prefix when it is alone.
pub fn settings(config: &Config) -> Vec<Step> {
    let mut steps = vec![
        setting("run", 0, &[RUN]),
        setting("measurement rate", 0, &change(7, &[(config.rate_hz * 256.0).round() as u16])),
    ];
    for &address in &config.addresses() {
        let mut set = |about, command: &[u8]| steps.push(setting(about, address, command));
        set("line frequency", &[CHANGE, 20, config.line_frequency_hz]);
        if let Some(code) = config.scale_code() {
            set("scale", &change(3, &[code]));
        }
        set("filters", &change(4, &[config.filters_off()]));
        for (about, parameter, table) in config.filter_tables() {
            set(about, &change(parameter, &table));
        }
        set("sudden change lock", &[CHANGE, 14, u8::from(config.sudden_change_lock)]);
        set("hemisphere", &hemisphere(config.hemisphere));
        set("metal", &[METAL, u8::from(config.metal), 0]);
    }
    steps
}

/// Begins the stream; with every 1st, 2nd, 8th or 32nd measurement in it.
pub fn stream(report_every: u8) -> [Step; 2] {
    let rate = match report_every {
        2 => b'R',
        8 => b'S',
        32 => b'T',
        _ => b'Q',
    };
    let begin = Step { about: "stream", send: vec![STREAM], wait: Duration::ZERO };
    [setting("report rate", 0, &[rate]), begin]
}

/// CHANGE with words.
fn change(parameter: u8, words: &[u16]) -> Vec<u8> {
    let mut bytes = vec![CHANGE, parameter];
    bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
    bytes
}

/// The command for a half of space: axis and sign.
fn hemisphere(hemisphere: Hemisphere) -> [u8; 3] {
    let [axis, sign] = hemisphere.code();
    [HEMISPHERE, axis, sign]
}
