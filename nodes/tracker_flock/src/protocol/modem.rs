//! The line RTS, by which a host holds a bird in standby (manual, pages 28 to 31). A pseudo-terminal has no such line: there
//! these steps are left out, and nothing here is seen by the tests that listen to one.

use std::time::Duration;

/// What is done with RTS.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rts {
    /// High holds the bird in standby, low lets it fly.
    pub high: bool,
    /// How long to wait behind it.
    pub wait: Duration,
}

/// The manual's times for a reset: high for so long, and quiet for so long behind it.
const RESET_HIGH: Duration = Duration::from_secs(1);
const START_UP: Duration = Duration::from_secs(2);

/// What comes before the first word to a bird. With `reset`, the reset by RTS. Without it nothing when the port was just
/// found; when it is opened again, the start-up is waited for, since systems raise RTS for a moment as they open a port,
/// and with a fully wired cable that has just reset the bird.
pub fn wake(reset: bool, opened_before: bool) -> Vec<Rts> {
    let fly = Rts { high: false, wait: START_UP };
    match (reset, opened_before) {
        (true, _) => vec![Rts { high: true, wait: RESET_HIGH }, fly],
        (false, true) => vec![fly],
        (false, false) => Vec::new(),
    }
}

/// How long to wait before a bird that does not answer is asked once more, before anything is said of it: opening the port
/// for the first time may have reset it as well, and nobody knows how the cable is wired. A bird that was not reset answers
/// at once, and is not waited for.
pub fn second_chance(reset: bool, opened_before: bool) -> Option<Duration> {
    (!reset && !opened_before).then_some(START_UP)
}
