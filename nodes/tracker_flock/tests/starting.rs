//! A bird that does not answer at once, on a line with modem lines: opening the port may have reset it. That it is silent is
//! said before its start-up is waited for. A pseudo-terminal has no such lines: here RTS is wired past it to the played bird.

#![cfg(feature = "serial")]
#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{Device as _, FaultsConfig, HostClock, Line, Pty, RaiseRts, Trouble};
use std::sync::Arc;
use std::time::Duration;
use tracker_flock::Config;
use tracker_flock::emulator::{EmulatorConfig, FlockEmulator, Mood, World};
use tracker_flock::port::Flock;

type Plugged = Arc<Pty<FlockEmulator>>;

fn plugged(clock: HostClock) -> Plugged {
    let world: World = Box::new(|_, _| (Vector3::new(0.3, 0.1, 0.2), UnitQuaternion::from_euler_angles(0.3, 0.4, 0.5)));
    let flock = FlockEmulator::new(EmulatorConfig::default(), world);
    Arc::new(Pty::start(flock, FaultsConfig::default(), clock, None).unwrap())
}

/// The driver and its line, opened as with a fully wired cable; or with one on which RTS ends nowhere.
fn opened(bird: &Plugged, clock: HostClock, reset: bool, fully_wired: bool) -> (Flock, Line) {
    let flock = Flock::new(Config { port: bird.path().to_owned(), reset, ..Config::default() });
    let mut line = Line::open(&flock.line_settings(), clock, Arc::default()).unwrap();
    let wired = bird.clone();
    let mut raise: RaiseRts = Box::new(move |high| {
        if fully_wired {
            wired.device().set_rts(high, clock.now_nanos());
        }
        true
    });
    // What a system does as it opens a port.
    raise(true);
    line.wire_rts(raise);
    (flock, line)
}

fn sentence(outcome: Result<String, Trouble>) -> (bool, String) {
    let trouble = outcome.unwrap_err();
    (matches!(trouble, Trouble::Starting(_)), trouble.to_string())
}

#[test]
fn a_silent_bird_is_told_before_its_start_up_is_waited_for() {
    let clock = HostClock::start();
    let bird = plugged(clock);
    bird.device().set_mood(Mood::Silent);
    let (mut flock, mut line) = opened(&bird, clock, false, false);
    for _opening in ["the first", "the port is opened again"] {
        let (starting, told) = sentence(flock.set_up(&mut line));
        assert!(starting && told.contains("says nothing") && told.contains("may be starting up"), "{told}");
        let (starting, told) = sentence(flock.set_up(&mut line));
        assert!(!starting && told.contains("says nothing") && !told.contains("starting up"), "{told}");
    }
}

#[test]
fn what_is_no_bird_is_told_before_as_well() {
    let clock = HostClock::start();
    let bird = plugged(clock);
    bird.device().set_mood(Mood::WrongBaud);
    let (mut flock, mut line) = opened(&bird, clock, false, false);
    let (starting, told) = sentence(flock.set_up(&mut line));
    assert!(starting && told.contains("no record of a bird"), "{told}");
}

#[test]
fn a_bird_that_opening_the_port_has_reset_is_asked_again_and_flies() {
    let clock = HostClock::start();
    let bird = plugged(clock);
    let (mut flock, mut line) = opened(&bird, clock, false, true);
    assert!(sentence(flock.set_up(&mut line)).0);
    assert!(flock.set_up(&mut line).unwrap().contains("6DFOB"));
    // Nothing resets it now.
    assert!(flock.set_up(&mut line).is_ok(), "a bird that was not reset answers at once");
}

#[test]
fn a_reset_that_was_asked_for_is_told_first() {
    let clock = HostClock::start();
    let bird = plugged(clock);
    let (mut flock, mut line) = opened(&bird, clock, true, true);
    let (starting, told) = sentence(flock.set_up(&mut line));
    assert!(starting && told.contains("is reset by RTS"), "{told}");
    assert!(flock.set_up(&mut line).unwrap().contains("6DFOB"));
}

/// Until the first word about a bird that does not answer: the line's being drained, and the driver's listening.
#[test]
fn the_first_word_comes_within_a_second() {
    assert!(Flock::FIRST_WORD < Duration::from_millis(950), "{:?}", Flock::FIRST_WORD);
}
