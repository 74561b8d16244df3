//! Standby and reset by RTS: the driver's steps, in their order and with their waits, before a bird that obeys them. What
//! it says meanwhile is in `starting.rs`.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use nalgebra::{UnitQuaternion, Vector3};
use serial_line::Emulated as _;
use tracker_flock::emulator::{EmulatorConfig, FlockEmulator, World};
use tracker_flock::protocol::commands::{POINT, STREAM, auto_configuration};
use tracker_flock::protocol::modem::{Rts, wake};

/// A flock, and the moment.
struct Played {
    flock: FlockEmulator,
    nanos: i64,
}

impl Played {
    fn new(units: u8) -> Self {
        let world: World = Box::new(|_, _| (Vector3::new(0.3, 0.1, 0.2), UnitQuaternion::identity()));
        Self { flock: FlockEmulator::new(EmulatorConfig { units, ..EmulatorConfig::default() }, world), nanos: 0 }
    }

    fn hear(&mut self, bytes: &[u8]) -> &mut Self {
        self.flock.hear(bytes, self.nanos);
        self
    }

    /// What is said in so many milliseconds.
    fn said(&mut self, millis: i64) -> Vec<u8> {
        let (mut said, until) = (Vec::new(), self.nanos + millis * 1_000_000);
        while self.nanos < until {
            self.nanos += 1_000_000;
            said.extend(std::iter::from_fn(|| self.flock.speak(self.nanos)).flat_map(|(_, bytes)| bytes));
        }
        said
    }

    /// Carries out what the driver does with RTS; what is said meanwhile.
    fn wake(&mut self, steps: &[Rts]) -> Vec<u8> {
        let mut said = Vec::new();
        for step in steps {
            self.flock.set_rts(step.high, self.nanos);
            said.extend(self.said(step.wait.as_millis() as i64));
        }
        said
    }
}

/// EXAMINE: the number of the format, and whether the flock is configured.
fn format_and_configured(played: &mut Played) -> (u8, bool) {
    let answer = played.hear(&[b'O', 0]).said(20);
    let status = tracker_flock::protocol::examine::Status::of(answer.try_into().unwrap());
    (status.format_code(), status.is_configured())
}

#[test]
fn the_order_is_high_then_low_then_quiet() {
    let seconds = |steps: Vec<Rts>| steps.iter().map(|step| (step.high, step.wait.as_secs())).collect::<Vec<_>>();
    assert_eq!(seconds(wake(true, false)), [(true, 1), (false, 2)]);
    assert_eq!(seconds(wake(true, true)), [(true, 1), (false, 2)]);
    assert_eq!(seconds(wake(false, true)), [(false, 2)], "opening the port may have reset it");
    assert_eq!(seconds(wake(false, false)), []);
}

#[test]
fn a_reset_makes_a_bird_forget_and_then_it_answers() {
    let mut played = Played::new(0);
    assert!(!played.hear(&[b'Z', STREAM]).said(100).is_empty());
    played.hear(&[POINT]).said(50);
    assert_eq!(format_and_configured(&mut played), (5, true), "position and matrix");
    played.hear(&[STREAM]).said(50);
    assert!(played.wake(&wake(true, false)).is_empty(), "neither in standby nor while it starts up");
    assert_eq!(format_and_configured(&mut played), (4, true), "position and angles, as after power-up");
    assert_eq!(played.hear(&[POINT]).said(20).len(), 12);
}

#[test]
fn a_flock_wants_to_be_configured_anew_behind_a_reset() {
    let mut played = Played::new(2);
    let configure = |played: &mut Played| {
        for step in auto_configuration(2) {
            played.hear(&step.send).said(step.wait.as_millis() as i64);
        }
    };
    configure(&mut played);
    assert!(format_and_configured(&mut played).1);
    played.wake(&wake(true, false));
    assert!(!format_and_configured(&mut played).1);
    assert!(played.hear(&[POINT]).said(20).is_empty());
    configure(&mut played);
    assert_eq!(played.hear(&[POINT]).said(20).len(), 12);
}

#[test]
fn while_rts_is_high_a_bird_neither_hears_nor_speaks() {
    let mut played = Played::new(0);
    played.hear(&[STREAM]).said(50);
    played.flock.set_rts(true, played.nanos);
    played.said(20);
    assert!(played.hear(&[POINT]).said(5000).is_empty(), "the trap of a system that raises RTS as it opens a port");
}
