//! A terminal that somebody sits before: a pseudo-terminal with a memory.

use crate::rig::wait_until;
use serial_line::{Emulated, FaultsConfig, HostClock, Pty};
use std::collections::VecDeque;
use std::fs::File;
use std::process::{Child, Command, Stdio};

/// Shows what it is sent, and is typed on.
#[derive(Debug, Default)]
struct Screen {
    shown: Vec<u8>,
    typed: VecDeque<u8>,
}

impl Emulated for Screen {
    fn hear(&mut self, bytes: &[u8], _now_nanos: i64) {
        self.shown.extend_from_slice(bytes);
    }

    fn speak(&mut self, now_nanos: i64) -> Option<(i64, Vec<u8>)> {
        self.typed.pop_front().map(|key| (now_nanos, vec![key]))
    }
}

/// A program on a terminal. Dropped, it is killed.
pub struct Seated(Child);

impl Seated {
    /// The process.
    pub fn pid(&self) -> u32 {
        self.0.id()
    }

    /// Whether it runs.
    pub fn runs(&mut self) -> bool {
        matches!(self.0.try_wait(), Ok(None))
    }

    /// Waits until it has ended, and returns whether it was content.
    ///
    /// # Panics
    /// When it does not end.
    pub fn ends_well(&mut self) -> bool {
        wait_until("the program ends", || !self.runs());
        self.0.wait().is_ok_and(|status| status.success())
    }
}

impl Drop for Seated {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A terminal of 40 rows of 160 characters. It is nobody's controlling terminal: Ctrl-C is a signal, as
/// [`crate::rig::signal`] sends it.
pub struct Terminal {
    pty: Pty<Screen>,
    /// Held open, so that it stays while one program follows the other.
    line: File,
}

impl Terminal {
    /// Switches it on.
    ///
    /// # Panics
    /// When the system has none.
    pub fn open() -> Self {
        let Ok(pty) = Pty::start(Screen::default(), FaultsConfig::default(), HostClock::start(), None) else {
            panic!("the system gives no pseudo-terminal")
        };
        let Ok(line) = File::options().read(true).write(true).open(pty.path()) else {
            panic!("{} cannot be opened", pty.path().display())
        };
        let sized = Command::new("stty").args(["rows", "40", "cols", "160", "-F"]).arg(pty.path()).status();
        assert!(sized.is_ok_and(|status| status.success()), "stty gives the terminal no size");
        Self { pty, line }
    }

    /// Starts a program on it.
    ///
    /// # Panics
    /// When it cannot be started.
    pub fn start(&self, command: &mut Command) -> Seated {
        let line = || self.line.try_clone().map(Stdio::from);
        let (Ok(stdin), Ok(stdout), Ok(stderr)) = (line(), line(), line()) else { panic!("the terminal is gone") };
        match command.stdin(stdin).stdout(stdout).stderr(stderr).spawn() {
            Ok(child) => Seated(child),
            Err(error) => panic!("{command:?}: {error}"),
        }
    }

    /// Types.
    pub fn press(&self, keys: &str) {
        self.pty.device().typed.extend(keys.bytes());
    }

    /// All that was ever shown, with the terminal's own signs in between.
    pub fn shown(&self) -> String {
        String::from_utf8_lossy(&self.pty.device().shown).into_owned()
    }

    /// What stands on it now, row by row: what a program that moves the cursor about has drawn.
    pub fn screen(&self) -> String {
        let shown = self.shown();
        let mut cells = vec![vec![' '; 160]; 40];
        let (mut row, mut column) = (0, 0);
        let mut signs = shown.chars();
        while let Some(sign) = signs.next() {
            match sign {
                // ECMA-48, 5.4: CSI, parameters, and a letter; of these only CUP moves the cursor here.
                '\u{1b}' if signs.as_str().starts_with('[') => {
                    let rest = &signs.as_str()[1..];
                    let end = rest.find(|c: char| ('\u{40}'..='\u{7e}').contains(&c)).unwrap_or(rest.len());
                    if rest[end..].starts_with('H') {
                        let mut at =
                            rest[..end].split(';').map(|number| number.parse::<usize>().unwrap_or(1).max(1) - 1);
                        (row, column) = (at.next().unwrap_or(0), at.next().unwrap_or(0));
                    }
                    signs = rest.get(end + 1..).unwrap_or_default().chars();
                }
                sign if sign.is_control() => {}
                sign => {
                    if let Some(cell) = cells.get_mut(row).and_then(|cells: &mut Vec<char>| cells.get_mut(column)) {
                        *cell = sign;
                    }
                    column += 1;
                }
            }
        }
        cells.into_iter().map(|row| row.into_iter().collect::<String>() + "\n").collect()
    }

    /// Waits until it has shown these words, in this order.
    ///
    /// # Panics
    /// When it does not.
    pub fn wait_for(&self, words: &[&str]) {
        let mut shown = String::new();
        let in_order = |shown: &str| {
            words.iter().try_fold(shown, |rest, word| rest.split_once(word).map(|(_, behind)| behind)).is_some()
        };
        wait_until(&format!("{words:?} on the terminal"), || {
            shown = self.shown();
            in_order(&shown)
        });
    }
}
