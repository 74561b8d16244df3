//! What is said to the lights, and what they answer; no port, no clock.
//!
//! Dialect `limn`, lines of ASCII that end with a line feed:
//!
//! | sent | meaning | answer |
//! |---|---|---|
//! | `light?` | who is there | `limn-light 1` |
//! | `light 1 0` | laser on, lamp off; to be said again within a second, or both go out | `ok 1 0` |
//!
//! Anything else is answered by `? ` and the line. The second's grace is for safety: a laser does not stay on when the
//! cable is cut or the program dies.
//!
//! Dialect `horus` (the board of BQ's Ciclop, and what is flashed with horus-fw): G-code lines. `M71 T1` switches output 1
//! on, `M70 T1` off; each is answered by `ok`. Ctrl-X resets the board, which then says `Horus 0.2 ['$' for help]`.

use crate::config::Config;
use serde::{Deserialize, Serialize};
use wire::Light;

/// What the lights understand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dialect {
    /// The sketch in docs/hardware.md.
    #[default]
    Limn,
    /// The board of a Ciclop.
    Horus,
}

/// What came back.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// Who is there.
    Greeting(String),
    /// It is done; the state, where the dialect tells it.
    Done(Option<Light>),
    /// It was not understood.
    Refused(String),
}

/// Longer lines are no answers.
const LONGEST_LINE: usize = 80;

/// What makes the lights say who they are, from whatever state.
pub fn greeting(dialect: Dialect) -> &'static [u8] {
    match dialect {
        // The line feed ends what another program may have begun.
        Dialect::Limn => b"\nlight?\n",
        Dialect::Horus => b"\x18\r\n",
    }
}

/// What is sent to switch both lights. A Ciclop's board takes one output a line.
pub fn switch(config: &Config, light: Light) -> Vec<String> {
    let Light { laser, lamp } = light;
    match config.dialect {
        Dialect::Limn => vec![format!("light {} {}\n", u8::from(laser), u8::from(lamp))],
        Dialect::Horus => {
            let output = |on: bool, output: u8| format!("M7{}T{output}\r\n", u8::from(on));
            let mut lines = vec![output(laser, config.horus_laser)];
            lines.extend(config.horus_lamp.map(|number| output(lamp, number)));
            // What goes out goes out first: both at once light no picture of use.
            lines.sort_unstable();
            lines
        }
    }
}

/// Gathers bytes into answers.
#[derive(Debug, Clone)]
pub struct Answers {
    dialect: Dialect,
    line: Vec<u8>,
    too_long: bool,
}

impl Answers {
    /// Of this dialect.
    pub fn new(dialect: Dialect) -> Self {
        Self { dialect, line: Vec::with_capacity(LONGEST_LINE), too_long: false }
    }

    /// Takes the next byte; the answer that it ends.
    pub fn push(&mut self, byte: u8) -> Option<Answer> {
        if !matches!(byte, b'\n' | b'\r') {
            if self.line.len() < LONGEST_LINE {
                self.line.push(byte);
            } else {
                self.too_long = true;
            }
            return None;
        }
        let line = String::from_utf8_lossy(&self.line).trim().to_owned();
        self.line.clear();
        let too_long = std::mem::take(&mut self.too_long);
        if line.is_empty() {
            None
        } else if too_long {
            Some(Answer::Refused(line))
        } else {
            Some(self.read(line))
        }
    }

    fn read(&self, line: String) -> Answer {
        match (self.dialect, line.as_str()) {
            (Dialect::Limn, text) if text.starts_with("limn-light ") => Answer::Greeting(line),
            (Dialect::Limn, text) => match text.strip_prefix("ok ").and_then(state) {
                Some(light) => Answer::Done(Some(light)),
                None => Answer::Refused(line),
            },
            (Dialect::Horus, text) if text.starts_with("Horus ") => Answer::Greeting(line),
            (Dialect::Horus, "ok") => Answer::Done(None),
            (Dialect::Horus, _) => Answer::Refused(line),
        }
    }
}

fn state(text: &str) -> Option<Light> {
    let (laser, lamp) = text.split_once(' ')?;
    let on = |text: &str| match text {
        "0" => Some(false),
        "1" => Some(true),
        _ => None,
    };
    Some(Light { laser: on(laser)?, lamp: on(lamp)? })
}
