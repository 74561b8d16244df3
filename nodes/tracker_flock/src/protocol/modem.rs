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

/// What comes before the first word to a bird: with `reset`, the reset by RTS; without it, nothing.
///
/// Opening the port may reset a bird as well, since systems raise RTS for a moment as they do so, and nobody knows how its
/// cable is wired. So a bird that does not answer is `starting`: its start-up is waited for before it is asked once more. One
/// that was not reset answers at once, and is not waited for.
pub fn wake(reset: bool, starting: bool) -> Vec<Rts> {
    let fly = Rts { high: false, wait: START_UP };
    match (reset, starting) {
        (true, _) => vec![Rts { high: true, wait: RESET_HIGH }, fly],
        (false, true) => vec![fly],
        (false, false) => Vec::new(),
    }
}
