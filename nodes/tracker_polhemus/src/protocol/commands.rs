//! What the host says, as a plain list of steps.

use super::records::{Family, Layout};
use crate::config::Config;
use serial_line::Step;
use std::time::Duration;

/// Between two commands: the device works on one after the other.
const COMMAND_WAIT: Duration = Duration::from_millis(50);

fn step(about: &'static str, command: impl Into<Vec<u8>>) -> Step {
    Step { about, send: command.into(), wait: COMMAND_WAIT }
}

/// Ends whatever it is doing: a question that waits for an answer, the stream, binary answers.
pub fn hush(family: Family) -> Vec<Step> {
    match family {
        Family::Fastrak => vec![step("end the stream", "c"), step("text", "F")],
        _ => vec![step("end a question", "\r"), step("text", "F0\r"), step("end the stream", "P")],
    }
}

/// The question who it is, and the most bytes of the answer.
pub fn who(family: Family) -> (&'static [u8], usize) {
    match family {
        Family::Fastrak => (b"S", super::status::FASTRAK_STATUS_BYTES),
        _ => (b"\x16\r", super::status::WHO_AM_I_BYTES),
    }
}

/// All settings, station for station.
pub fn settings(config: &Config) -> Vec<Step> {
    let fastrak = config.family == Family::Fastrak;
    let mut steps = vec![step("inches", if fastrak { "U" } else { "U0\r" })];
    if fastrak {
        for station in 1..=config.family.most_stations() {
            let on = u8::from(config.stations.contains(&station));
            steps.push(step("station on or off", format!("l{station},{on}\r")));
        }
    }
    if config.family == Family::Liberty {
        let rate = if config.sheet().rate_hz > 120.0 { "R4\r" } else { "R3\r" };
        steps.push(step("240 or 120 frames a second", rate));
    }
    let list = output_list(&Layout::of(config.family));
    let [x, y, z] = config.hemisphere;
    for &station in &config.stations {
        steps.push(step("output list", format!("O{station},{list}\r")));
        steps.push(step("hemisphere", format!("H{station},{x},{y},{z}\r")));
    }
    let filter = if config.filter { "0.2,0.2,0.8,0.8" } else { "0,1,0,0" };
    let letters = if fastrak { ["x", "v"] } else { ["X", "Y"] };
    steps.extend(letters.map(|letter| step("filter", format!("{letter}{filter}\r"))));
    steps
}

/// Begins the stream; with a clock, from zero.
pub fn stream(family: Family) -> Vec<Step> {
    match family {
        Family::Fastrak => vec![step("binary", "f"), step("stream", "C")],
        _ => vec![step("binary", "F1\r"), step("clock to zero", "Q0\r"), step("stream", "C\r")],
    }
}

/// Numbers of the fields, with commas; fields that the device does not have are left out.
pub fn output_list(layout: &Layout) -> String {
    let codes = layout.items.iter().filter_map(|item| item.code(layout.family));
    codes.map(|code| code.to_string()).collect::<Vec<_>>().join(",")
}
