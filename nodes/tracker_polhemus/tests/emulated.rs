//! The driver against trackers that are played byte for byte behind a pseudo-terminal.

#![cfg(feature = "serial")]
#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

#[path = "../../serial_line/tests/harness/listener.rs"]
mod harness;

use harness::Listener;
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{Device as _, FaultsConfig, HostClock, Pty};
use std::path::Path;
use std::time::Duration;
use tracker_polhemus::emulator::{EmulatorConfig, Mood, PolhemusEmulator, World};
use tracker_polhemus::port::Polhemus;
use tracker_polhemus::protocol::records::Family;
use tracker_polhemus::{Config, PolhemusTracker};

/// Each station on a circle of its own, at 0.4 m/s.
fn circle(station: u8, nanos: i64) -> (Vector3<f64>, UnitQuaternion<f64>) {
    let t = nanos as f64 * 1e-9 * 2.0;
    let position = Vector3::new(0.4 + 0.05 * f64::from(station), 0.2 * t.sin(), 0.2 * t.cos());
    (position, UnitQuaternion::from_euler_angles(0.5, 0.3 * t.sin(), 0.2))
}

/// The driver as configured.
fn listen(config: Config, clock: HostClock) -> Listener<PolhemusTracker> {
    let device = Polhemus::new(config.clone());
    let line = device.line_settings();
    Listener::start(device, line, PolhemusTracker::new(config).unwrap(), clock)
}

fn plugged(
    config: EmulatorConfig,
    faults: FaultsConfig,
    link: Option<&Path>,
    clock: HostClock,
) -> Pty<PolhemusEmulator> {
    let world: World = Box::new(circle);
    Pty::start(PolhemusEmulator::new(config, world), faults, clock, link).unwrap()
}

#[test]
fn each_family_is_set_up_and_heard() {
    for (family, name) in [(Family::Fastrak, "FASTRAK"), (Family::Liberty, "Liberty"), (Family::Patriot, "Patriot")] {
        let clock = HostClock::start();
        let faults = FaultsConfig { seed: 3, jitter_nanos: 3_000_000, lost_ppm: 100, ..FaultsConfig::default() };
        let stations = vec![1, 2];
        let config = Config { family, stations, ..Config::default() };
        let rate_hz = config.sheet().rate_hz;
        let emulator = EmulatorConfig { stations: 2, rate_hz, ..EmulatorConfig::of(family) };
        let pty = plugged(emulator, faults, None, clock);
        let mut rig = listen(Config { port: pty.path().to_owned(), ..config }, clock);
        assert!(rig.streaming().contains(name));
        rig.poses(150);
        for pose in rig.poses(60) {
            let (truth, turned) = circle(pose.sensor as u8 + 1, pose.pose.header.stamp_nanos);
            let rigid = pose.pose.world_from_body;
            let off = (Vector3::from(rigid.translation_m) - truth).norm();
            assert!(off < 5e-3, "{family:?}: {off} m, {} ms of time", off / 0.4 * 1e3);
            let [w, x, y, z] = rigid.rotation_wxyz;
            let rotation = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
            assert!(rotation.angle_to(&turned) < 0.01);
        }
    }
}

#[test]
fn each_illness_is_its_own_sentence_and_is_survived() {
    let clock = HostClock::start();
    let pty = plugged(EmulatorConfig::of(Family::Liberty), FaultsConfig::default(), None, clock);
    let mut rig = listen(Config { port: pty.path().to_owned(), ..Config::default() }, clock);
    rig.poses(20);
    for (mood, words) in [(Mood::Silent, "says nothing"), (Mood::WrongBaud, "no record of a Liberty")] {
        rig.survives(words, || pty.device().set_mood(mood), || pty.device().set_mood(Mood::Well));
    }
}

#[test]
fn a_half_dead_line_is_named_and_goes_on() {
    for family in [Family::Fastrak, Family::Liberty] {
        let clock = HostClock::start();
        let faults = FaultsConfig { seed: 5, lost_ppm: 15_000, ..FaultsConfig::default() };
        let pty = plugged(EmulatorConfig::of(family), faults, None, clock);
        let mut rig = listen(Config { port: pty.path().to_owned(), family, ..Config::default() }, clock);
        let told = rig.noisy();
        assert!(told.contains("belong to no record"), "{told}");
        rig.poses(20);
    }
}

#[test]
fn a_port_that_is_pulled_and_plugged_in_again_goes_on() {
    let clock = HostClock::start();
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("tracker");
    let family = Family::Fastrak;
    let pty = plugged(EmulatorConfig::of(family), FaultsConfig::default(), Some(&link), clock);
    let mut rig = listen(Config { port: link.clone(), family, ..Config::default() }, clock);
    rig.poses(50);
    let again = || plugged(EmulatorConfig::of(family), FaultsConfig::default(), Some(&link), clock);
    let _again = rig.survives("went away", || drop(pty), again);
    assert_eq!(rig.session.counts().starts, 2);
}

#[test]
fn another_device_than_was_configured_is_named() {
    let clock = HostClock::start();
    let pty = plugged(EmulatorConfig::of(Family::Patriot), FaultsConfig::default(), None, clock);
    let config = Config { port: pty.path().to_owned(), family: Family::Fastrak, ..Config::default() };
    let told = listen(config, clock).trouble();
    assert!(told.contains("says nothing") || told.contains("no record of a Fastrak"), "{told}");
}

/// A line that went away is an error at once, and one that is half dead is named within a second whatever it says
/// (`serial_line`'s tests of `Noise`). What is silent, or says what is no record, has this long.
#[test]
fn silence_and_garbage_are_named_within_a_second() {
    for family in [Family::Fastrak, Family::Liberty, Family::Patriot] {
        let most = Polhemus::new(Config { family, ..Config::default() }).most_silence();
        assert!(most < Duration::from_millis(900), "{family:?}: {most:?}, and a look at the line takes 20 ms");
    }
}

#[test]
fn what_cannot_be_opened_is_named_with_what_to_do() {
    let clock = HostClock::start();
    let told = |port: &Path| listen(Config { port: port.to_owned(), ..Config::default() }, clock).trouble();
    assert!(told(Path::new("/dev/no_such_tracker")).contains("plug the adapter in"));
    let file = tempfile::NamedTempFile::new().unwrap();
    assert!(told(file.path()).contains("is no serial port"));
    let pty = plugged(EmulatorConfig::of(Family::Liberty), FaultsConfig::default(), None, clock);
    let mut rig = listen(Config { port: pty.path().to_owned(), ..Config::default() }, clock);
    rig.poses(3);
    assert!(told(pty.path()).contains("is in use by another program"));
    rig.poses(3);
}

#[test]
fn a_line_that_is_cut_is_named_and_goes_on_when_it_is_whole_again() {
    let clock = HostClock::start();
    let second = 1_000_000_000;
    let faults = FaultsConfig { cut_every_nanos: 4 * second, cut_for_nanos: second, ..FaultsConfig::default() };
    let pty = plugged(EmulatorConfig::of(Family::Liberty), faults, None, clock);
    let mut rig = listen(Config { port: pty.path().to_owned(), ..Config::default() }, clock);
    rig.streaming();
    let told = rig.trouble();
    assert!(told.contains("says nothing"), "{told}");
    rig.streaming();
    rig.poses(20);
}
