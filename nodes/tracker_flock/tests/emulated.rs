//! The driver against a flock that is played byte for byte behind a pseudo-terminal.

#![cfg(feature = "serial")]
#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

#[path = "../../serial_line/tests/harness/listener.rs"]
mod harness;

use harness::Listener;
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{Device as _, FaultsConfig, HostClock, PoseTracker as _, Pty, SensorPose};
use std::path::Path;
use std::time::Duration;
use tracker_flock::emulator::{EmulatorConfig, FlockEmulator, Mood, TestMode, World};
use tracker_flock::port::Flock;
use tracker_flock::protocol::address::Addressing;
use tracker_flock::protocol::reading::QuaternionSense;
use tracker_flock::protocol::records::Format;
use tracker_flock::{Config, FlockTracker};
use wire::Quality;

/// To and fro at up to half a metre a second, so that a position tells the time to a few tenths of a millisecond.
fn swing(unit: u8, nanos: i64) -> (Vector3<f64>, UnitQuaternion<f64>) {
    let t = nanos as f64 * 1e-9;
    let position = Vector3::new(0.4 + 0.02 * f64::from(unit), 0.25 * (2.0 * t).sin(), 0.25 * (2.0 * t).cos());
    (position, UnitQuaternion::from_euler_angles(0.3 * t.sin(), 0.4, 0.5))
}

fn still(_: u8, _: i64) -> (Vector3<f64>, UnitQuaternion<f64>) {
    (Vector3::new(0.3, -0.1, 0.2), UnitQuaternion::from_euler_angles(0.3, 0.4, 0.5))
}

/// The driver as configured.
fn listen(config: Config, clock: HostClock) -> Listener<FlockTracker> {
    let flock = Flock::new(config.clone());
    let line = flock.line_settings();
    Listener::start(flock, line, FlockTracker::new(config).unwrap(), clock)
}

fn plugged(
    config: EmulatorConfig,
    faults: FaultsConfig,
    world: impl Fn(u8, i64) -> (Vector3<f64>, UnitQuaternion<f64>) + Send + 'static,
    link: Option<&Path>,
    clock: HostClock,
) -> Pty<FlockEmulator> {
    let world: World = Box::new(world);
    Pty::start(FlockEmulator::new(config, world), faults, clock, link).unwrap()
}

fn on(pty: &Pty<FlockEmulator>) -> Config {
    Config { port: pty.path().to_owned(), rate_hz: 100.0, ac_narrow_filter: false, ..Config::default() }
}

/// How far stamps are from the truth, by the position: root mean square in milliseconds.
fn stamp_error_ms(poses: &[SensorPose], unit: u8) -> f64 {
    let squares: f64 = poses
        .iter()
        .map(|pose| {
            let at = pose.pose.header.stamp_nanos;
            let (truth, _) = swing(unit, at);
            let velocity = (swing(unit, at + 1_000_000).0 - swing(unit, at - 1_000_000).0) / 2e-3;
            let off = Vector3::from(pose.pose.world_from_body.translation_m) - truth;
            (off.dot(&velocity) / velocity.norm_squared()).powi(2)
        })
        .sum();
    (squares / poses.len() as f64).sqrt() * 1e3
}

#[test]
fn ten_milliseconds_of_jitter_are_taken_off_the_stamps() {
    let clock = HostClock::start();
    let faults = FaultsConfig { seed: 5, jitter_nanos: 10_000_000, ..FaultsConfig::default() };
    let pty = plugged(EmulatorConfig::default(), faults, swing, None, clock);
    let mut rig = listen(on(&pty), clock);
    rig.streaming();
    let poses: Vec<SensorPose> =
        rig.poses(1200).into_iter().filter(|pose| pose.pose.quality == Quality::Good).collect();
    assert!(poses.len() > 1000, "{}", poses.len());
    let (all, first) = (stamp_error_ms(&poses, 0), stamp_error_ms(&poses[..100], 0));
    println!(
        "stamps {all:.3} ms rms of {}; {first:.3} in the first second; {:?}",
        poses.len(),
        rig.tracker.jitter_nanos(0)
    );
    // A quiet machine shows 0.3 to 0.45; a busy one looks at its line less often.
    assert!(all < 1.0, "{all} ms rms");
    // Evenly spread over 10 ms.
    let (rms, most) = rig.tracker.jitter_nanos(0).unwrap();
    assert!(rms > 2.2e6 && most > 7e6, "{rms} ns rms, {most} ns at most were taken off");
}

#[test]
fn a_sensor_that_is_saturated_in_mid_stream_is_named_and_the_others_go_on() {
    let clock = HostClock::start();
    let pty =
        plugged(EmulatorConfig { units: 2, ..EmulatorConfig::default() }, FaultsConfig::default(), swing, None, clock);
    let mut rig = listen(Config { sensors: vec![1, 2], ..on(&pty) }, clock);
    rig.poses(20);
    pty.device().set_mood(Mood::Saturated);
    let told = rig.noisy();
    assert!(told.contains("unit 1") && told.contains("the sensor is saturated: it is too near"), "{told}");
    let lost = rig.poses(20).pop().unwrap().pose;
    assert_eq!(lost.quality, Quality::Lost);
    pty.device().set_mood(Mood::Well);
    while rig.poses(1)[0].pose.quality == Quality::Lost {}
    assert_eq!(rig.session.counts().starts, 1, "it was asked, and not set up anew");
}

#[test]
fn a_sensor_beyond_the_scale_is_lost_with_the_reason() {
    let clock = HostClock::start();
    let pty = plugged(EmulatorConfig::default(), FaultsConfig::default(), swing, None, clock);
    let mut rig = listen(on(&pty), clock);
    rig.poses(20);
    pty.device().set_mood(Mood::OutOfRange);
    let lost = std::iter::repeat_with(|| rig.poses(1).remove(0).pose).find(|pose| pose.quality == Quality::Lost);
    assert!(lost.unwrap().reason.contains("end of the scale"));
}

#[test]
fn more_than_fourteen_units_are_addressed_as_their_switches_have_it() {
    let clock = HostClock::start();
    for (addressing, units) in [(Addressing::Expanded, 17), (Addressing::SuperExpanded, 34)] {
        let emulator = EmulatorConfig { units, addressing, first_sensor: units - 1, ..EmulatorConfig::default() };
        let pty = plugged(emulator, FaultsConfig::default(), still, None, clock);
        let config = Config { sensors: vec![units - 1, units], addressing, output: Format::PositionAngles, ..on(&pty) };
        let mut rig = listen(config.clone(), clock);
        let found = rig.streaming();
        assert!(found.contains(&format!("sensors on units [{}, {units}]", units - 1)), "{found}");
        let poses = rig.poses(40);
        assert!(poses.windows(2).all(|pair| pair[0].sensor != pair[1].sensor), "they speak in turn");
        let set: Vec<u8> = pty.device().settings().into_iter().filter(|unit| unit.4 == 50).map(|unit| unit.0).collect();
        assert_eq!(set, [units - 1, units], "line frequency of those that were set");
        drop(rig);
        let few = Config { addressing: Addressing::Normal, sensors: vec![1, 2], units: 2, ..config };
        let told = listen(few, clock).trouble();
        assert!(told.contains(&format!("set `addressing = \"{}\"`", addressing.name())), "{told}");
    }
}

#[test]
fn a_bird_alone_is_heard_with_jitter_and_bit_errors_and_its_stamps_are_true() {
    let clock = HostClock::start();
    let faults = FaultsConfig {
        seed: 3,
        jitter_nanos: 10_000_000,
        flipped_ppm: 200,
        lost_ppm: 200,
        garbage_ppm: 3000,
        ..FaultsConfig::default()
    };
    let pty = plugged(EmulatorConfig::default(), faults, swing, None, clock);
    let mut rig = listen(on(&pty), clock);
    assert!(rig.streaming().contains("6DFOB, revision 3.67"));
    let mut poses = Vec::new();
    // A machine that stands still for half a second lets the clock settle anew.
    while poses.len() < 150 {
        poses.extend(rig.poses(10).into_iter().filter(|pose| pose.pose.quality == Quality::Good));
    }
    // A bit error that leaves a rotation a rotation is not to be seen; the position it bends is left out here.
    let off = |pose: &SensorPose| {
        let truth = swing(0, pose.pose.header.stamp_nanos).0;
        (Vector3::from(pose.pose.world_from_body.translation_m) - truth).norm()
    };
    let good: Vec<SensorPose> = poses.into_iter().filter(|pose| off(pose) < 0.02).collect();
    assert!(good.len() > 130, "{}", good.len());
    let error = stamp_error_ms(&good, 0);
    println!("stamps {error:.3} ms rms; jitter {:?}; {:?}", rig.tracker.jitter_nanos(0), rig.session.counts());
    // Bits that were turned over bend some of the positions that tell the time here.
    assert!(error < 2.0, "{error} ms rms");
    let lag = good[0].pose.rotation_lag_nanos;
    assert_eq!(lag, -5_500_000, "orientations are younger than positions");
    assert_eq!(rig.session.counts().overflowed, 0);
}

#[test]
fn three_sensors_answer_in_group_mode_and_are_set_as_configured() {
    let clock = HostClock::start();
    let pty =
        plugged(EmulatorConfig { units: 3, ..EmulatorConfig::default() }, FaultsConfig::default(), swing, None, clock);
    let config = Config { sensors: vec![1, 2, 3], output: Format::PositionAngles, metal: true, ..on(&pty) };
    let mut rig = listen(config, clock);
    assert!(rig.streaming().contains("sensors on units [1, 2, 3]"));
    rig.poses(330);
    let poses = rig.poses(300);
    for unit in 1..=3 {
        let of: Vec<SensorPose> = poses.iter().filter(|pose| pose.sensor + 1 == usize::from(unit)).cloned().collect();
        assert!((99..=101).contains(&of.len()));
        let error = stamp_error_ms(&of, unit);
        assert!(error < 2.0, "unit {unit}: {error} ms rms");
    }
    for (_, format, filters_off, hemisphere, mains_hz) in pty.device().settings() {
        assert_eq!((format, filters_off, hemisphere, mains_hz), (4, 0b110, [0, 0], 50));
    }
}

#[test]
fn sensors_may_stand_behind_an_extended_range_controller() {
    let clock = HostClock::start();
    let emulator = EmulatorConfig { units: 3, first_sensor: 2, ..EmulatorConfig::default() };
    let pty = plugged(emulator, FaultsConfig::default(), still, None, clock);
    let mut rig = listen(Config { sensors: vec![2, 3], ..on(&pty) }, clock);
    let found = rig.streaming();
    assert!(found.contains("6DERC") && found.contains("sensors on units [2, 3]"), "{found}");
    let poses = rig.poses(40);
    assert!(poses.windows(2).all(|pair| pair[0].sensor != pair[1].sensor), "they speak in turn");
    drop(rig);
    let told = listen(Config { sensors: vec![1, 2], units: 3, ..on(&pty) }, clock).trouble();
    assert!(told.contains("unit 1") && told.contains("has no sensor"), "{told}");
}

#[test]
fn a_line_that_is_cut_is_named_and_goes_on_when_it_is_whole_again() {
    let clock = HostClock::start();
    let second = 1_000_000_000;
    let faults = FaultsConfig { cut_every_nanos: 4 * second, cut_for_nanos: second, ..FaultsConfig::default() };
    let pty = plugged(EmulatorConfig::default(), faults, swing, None, clock);
    let mut rig = listen(on(&pty), clock);
    let stamp = |pose: SensorPose| pose.pose.header.stamp_nanos;
    rig.streaming();
    let told = rig.trouble();
    assert!(told.contains("says nothing"), "{told}");
    rig.streaming();
    // What came before the cut, and something of what came behind it.
    let stamps: Vec<i64> = rig.poses(400).into_iter().map(stamp).collect();
    let gap = stamps.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap();
    assert!(gap >= second, "{gap}");
    assert!(stamps.iter().all(|nanos| !faults.is_cut(nanos + 10_000_000)), "nothing passes a cut line");
}

#[test]
fn the_quaternions_sense_is_settled_whichever_it_is() {
    for quaternion in [QuaternionSense::AsMatrix, QuaternionSense::Inverse] {
        let clock = HostClock::start();
        let pty = plugged(
            EmulatorConfig { quaternion, ..EmulatorConfig::default() },
            FaultsConfig::default(),
            still,
            None,
            clock,
        );
        let mut rig = listen(Config { output: Format::PositionQuaternion, ..on(&pty) }, clock);
        assert!(rig.streaming().contains("quaternions turn"));
        let pose = rig.poses(3).pop().unwrap().pose.world_from_body.rotation_wxyz;
        let [w, x, y, z] = pose;
        let turned = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
        assert!(turned.angle_to(&still(0, 0).1) < 1e-3, "{quaternion:?}");
    }
    let clock = HostClock::start();
    let straight = |_, _| (Vector3::new(0.3, 0.1, 0.2), UnitQuaternion::identity());
    let pty = plugged(EmulatorConfig::default(), FaultsConfig::default(), straight, None, clock);
    let mut rig = listen(Config { output: Format::PositionQuaternion, ..on(&pty) }, clock);
    assert!(rig.streaming().contains("matrices are sent"));
    rig.poses(3);
}

#[test]
fn each_illness_is_its_own_sentence_and_is_survived() {
    let clock = HostClock::start();
    let pty = plugged(EmulatorConfig::default(), FaultsConfig::default(), swing, None, clock);
    let mut rig = listen(on(&pty), clock);
    rig.poses(20);
    for (mood, words) in [
        (Mood::Silent, "says nothing"),
        (Mood::Test(TestMode::Output), "test mode"),
        (Mood::Test(TestMode::Echo), "test mode"),
        (Mood::Test(TestMode::Read), "test mode"),
        (Mood::Test(TestMode::Block), "test mode"),
        (Mood::WrongBaud, "no record of a bird"),
    ] {
        rig.survives(words, || pty.device().set_mood(mood), || pty.device().set_mood(Mood::Well));
    }
}

#[test]
fn a_half_dead_line_is_named_and_goes_on() {
    let clock = HostClock::start();
    let faults = FaultsConfig { seed: 5, lost_ppm: 30_000, ..FaultsConfig::default() };
    let pty = plugged(EmulatorConfig::default(), faults, swing, None, clock);
    let mut rig = listen(on(&pty), clock);
    let told = rig.noisy();
    assert!(told.contains("belong to no record"), "{told}");
    rig.poses(20);
}

#[test]
fn a_port_that_is_pulled_and_plugged_in_again_goes_on() {
    let clock = HostClock::start();
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("tracker");
    let config = Config { port: link.clone(), rate_hz: 100.0, ..Config::default() };
    let mut rig = listen(config, clock);
    assert!(rig.trouble().contains("there is no"));
    let pty = plugged(EmulatorConfig::default(), FaultsConfig::default(), swing, Some(&link), clock);
    rig.poses(50);
    let _again = rig.survives(
        "went away",
        || drop(pty),
        || plugged(EmulatorConfig::default(), FaultsConfig::default(), swing, Some(&link), clock),
    );
    assert_eq!(rig.session.counts().starts, 2);
}

#[test]
fn what_is_missing_in_the_flock_is_named() {
    let clock = HostClock::start();
    let pty =
        plugged(EmulatorConfig { units: 2, ..EmulatorConfig::default() }, FaultsConfig::default(), swing, None, clock);
    let rig = listen(Config { sensors: vec![1, 4], units: 4, ..on(&pty) }, clock);
    assert!(rig.trouble().contains("a unit does not answer on the FBB"));
    drop(rig);
    let alone =
        plugged(EmulatorConfig { error: 5, ..EmulatorConfig::default() }, FaultsConfig::default(), swing, None, clock);
    let rig = listen(on(&alone), clock);
    assert!(rig.streaming().contains("no sensor"), "an error that was reported is told");
    drop(rig);
    let near =
        plugged(EmulatorConfig { error: 32, ..EmulatorConfig::default() }, FaultsConfig::default(), swing, None, clock);
    let rig = listen(on(&near), clock);
    assert!(rig.streaming().contains("the sensor is saturated: it is too near the transmitter"));
    drop(rig);
    let fatal =
        plugged(EmulatorConfig { error: 1, ..EmulatorConfig::default() }, FaultsConfig::default(), swing, None, clock);
    assert!(listen(on(&fatal), clock).trouble().contains("needs repair"));
}

#[test]
fn a_port_that_another_has_is_busy() {
    let clock = HostClock::start();
    let pty = plugged(EmulatorConfig::default(), FaultsConfig::default(), swing, None, clock);
    let mut rig = listen(on(&pty), clock);
    rig.poses(3);
    let told = listen(on(&pty), clock).trouble();
    assert!(told.contains("in use by another program"), "{told}");
    rig.poses(3);
}

#[test]
fn a_file_is_no_serial_port() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let rig = listen(Config { port: file.path().to_owned(), ..Config::default() }, HostClock::start());
    let told = rig.trouble();
    assert!(told.contains("is no serial port"), "{told}");
}

/// A line that went away is an error at once, and one that is half dead is named within a second whatever it says
/// (`serial_line`'s tests of `Noise`). What is silent, or says what is no record, has this long.
#[test]
fn silence_and_garbage_are_named_within_a_second() {
    for rate_hz in [20.0, 50.0, 103.0, 144.0] {
        let most = Flock::new(Config { rate_hz, ..Config::default() }).most_silence();
        assert!(most < Duration::from_millis(900), "{rate_hz} Hz: {most:?}, and a look at the line takes 20 ms");
    }
    // Unless a record alone is longer to come.
    let seldom = Flock::new(Config { rate_hz: 20.0, report_every: 32, ..Config::default() });
    assert_eq!(seldom.most_silence(), Duration::from_secs_f64(4.0 * 32.0 / 20.0));
}
