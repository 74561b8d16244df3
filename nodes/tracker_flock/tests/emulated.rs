//! The driver against a flock that is played byte for byte behind a pseudo-terminal.

#![cfg(feature = "serial")]
#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{FaultsConfig, HostClock, News, Pty, Session};
use std::path::Path;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};
use tracker_flock::emulator::{EmulatorConfig, FlockEmulator, Mood, World};
use tracker_flock::port::Flock;
use tracker_flock::protocol::reading::QuaternionSense;
use tracker_flock::protocol::records::Format;
use tracker_flock::{Config, FlockTracker, Heard, SensorPose};
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

struct Rig {
    session: Session<Heard>,
    tracker: FlockTracker,
    news: Receiver<(Instant, News)>,
}

impl Rig {
    fn start(config: Config, clock: HostClock) -> Self {
        let flock = Flock::new(config.clone());
        let (say, news) = channel();
        let settings = flock.line_settings();
        let session = Session::start(flock, settings, clock, move |n| drop(say.send((Instant::now(), n))));
        Self { session, tracker: FlockTracker::new(config).unwrap(), news }
    }

    fn poses(&mut self, count: usize) -> Vec<SensorPose> {
        let (mut poses, started) = (Vec::new(), Instant::now());
        while poses.len() < count && started.elapsed() < Duration::from_secs(20) {
            let Some(arrived) = self.session.next(Duration::from_millis(50)) else { continue };
            poses.extend(self.tracker.process(&arrived.record, arrived.nanos, arrived.missed));
        }
        assert_eq!(poses.len(), count, "{:?}", self.news.try_iter().collect::<Vec<_>>());
        poses
    }

    fn trouble(&self) -> String {
        loop {
            if let (_, News::Trouble(trouble)) = self.news.recv_timeout(Duration::from_secs(10)).unwrap() {
                return trouble.to_string();
            }
        }
    }

    fn streaming(&self) -> String {
        loop {
            if let (_, News::Streaming(words)) = self.news.recv_timeout(Duration::from_secs(10)).unwrap() {
                return words;
            }
        }
    }
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
fn a_bird_alone_is_heard_with_jitter_and_bit_errors_and_its_stamps_are_true() {
    let clock = HostClock::start();
    let faults = FaultsConfig { seed: 3, jitter_nanos: 10_000_000, flipped_ppm: 200, lost_ppm: 200, garbage_ppm: 3000 };
    let pty = plugged(EmulatorConfig::default(), faults, swing, None, clock);
    let mut rig = Rig::start(on(&pty), clock);
    assert!(rig.streaming().contains("6DFOB, revision 3.67"));
    rig.poses(130);
    let poses = rig.poses(150);
    let good: Vec<SensorPose> = poses
        .into_iter()
        .filter(|pose| {
            let off = Vector3::from(pose.pose.world_from_body.translation_m) - swing(0, pose.pose.header.stamp_nanos).0;
            // A bit error that leaves a rotation a rotation is not to be seen; the position it bends is left out here.
            pose.pose.quality == Quality::Good && off.norm() < 0.02
        })
        .collect();
    assert!(good.len() > 130, "{}", good.len());
    let error = stamp_error_ms(&good, 0);
    println!("stamps {error:.3} ms rms; jitter {:?}; {:?}", rig.tracker.jitter_nanos(0), rig.session.counts());
    // The emulator looks at its clock every half millisecond, and a busy machine less often.
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
    let mut rig = Rig::start(config, clock);
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
        let mut rig = Rig::start(Config { output: Format::PositionQuaternion, ..on(&pty) }, clock);
        assert!(rig.streaming().contains("quaternions turn"));
        let pose = rig.poses(3).pop().unwrap().pose.world_from_body.rotation_wxyz;
        let [w, x, y, z] = pose;
        let turned = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
        assert!(turned.angle_to(&still(0, 0).1) < 1e-3, "{quaternion:?}");
    }
    let clock = HostClock::start();
    let straight = |_, _| (Vector3::new(0.3, 0.1, 0.2), UnitQuaternion::identity());
    let pty = plugged(EmulatorConfig::default(), FaultsConfig::default(), straight, None, clock);
    let mut rig = Rig::start(Config { output: Format::PositionQuaternion, ..on(&pty) }, clock);
    assert!(rig.streaming().contains("matrices are sent"));
    rig.poses(3);
}

#[test]
fn each_illness_is_its_own_sentence_and_is_survived() {
    let clock = HostClock::start();
    let pty = plugged(EmulatorConfig::default(), FaultsConfig::default(), swing, None, clock);
    let mut rig = Rig::start(on(&pty), clock);
    rig.poses(20);
    for (mood, words) in
        [(Mood::Silent, "says nothing"), (Mood::Test, "test mode"), (Mood::WrongBaud, "no record of a bird")]
    {
        while rig.news.try_recv().is_ok() {}
        let began = Instant::now();
        pty.device().set_mood(mood);
        let mut told = rig.trouble();
        println!("{mood:?}: named after {:?}: {told}", began.elapsed());
        // The stream ends before it is clear why.
        while !told.contains(words) {
            told = rig.trouble();
        }
        pty.device().set_mood(Mood::Well);
        rig.streaming();
        while rig.session.next(Duration::ZERO).is_some() {}
        rig.poses(20);
    }
}

#[test]
fn a_half_dead_line_is_named_and_goes_on() {
    let clock = HostClock::start();
    let faults = FaultsConfig { seed: 5, lost_ppm: 30_000, ..FaultsConfig::default() };
    let pty = plugged(EmulatorConfig::default(), faults, swing, None, clock);
    let mut rig = Rig::start(on(&pty), clock);
    let noisy =
        |(_, news): &(Instant, News)| matches!(news, News::Noisy(words) if words.contains("belong to no record"));
    assert!(std::iter::from_fn(|| rig.news.recv_timeout(Duration::from_secs(10)).ok()).any(|news| noisy(&news)));
    rig.poses(20);
}

#[test]
fn a_port_that_is_pulled_and_plugged_in_again_goes_on() {
    let clock = HostClock::start();
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("tracker");
    let config = Config { port: link.clone(), rate_hz: 100.0, ..Config::default() };
    let mut rig = Rig::start(config, clock);
    assert!(rig.trouble().contains("there is no"));
    let pty = plugged(EmulatorConfig::default(), FaultsConfig::default(), swing, Some(&link), clock);
    rig.poses(50);
    while rig.news.try_recv().is_ok() {}
    let began = Instant::now();
    drop(pty);
    let told = rig.trouble();
    println!("named after {:?}", began.elapsed());
    assert!(told.contains("went away"), "{told}");
    let _again = plugged(EmulatorConfig::default(), FaultsConfig::default(), swing, Some(&link), clock);
    rig.streaming();
    rig.poses(50);
    assert_eq!(rig.session.counts().starts, 2);
}

#[test]
fn what_is_missing_in_the_flock_is_named() {
    let clock = HostClock::start();
    let pty =
        plugged(EmulatorConfig { units: 2, ..EmulatorConfig::default() }, FaultsConfig::default(), swing, None, clock);
    let rig = Rig::start(Config { sensors: vec![1, 4], units: 4, ..on(&pty) }, clock);
    assert!(rig.trouble().contains("a unit does not answer on the FBB"));
    drop(rig);
    let alone =
        plugged(EmulatorConfig { error: 5, ..EmulatorConfig::default() }, FaultsConfig::default(), swing, None, clock);
    let rig = Rig::start(on(&alone), clock);
    assert!(rig.streaming().contains("no sensor"), "an error that was reported is told");
    drop(rig);
    let fatal =
        plugged(EmulatorConfig { error: 1, ..EmulatorConfig::default() }, FaultsConfig::default(), swing, None, clock);
    assert!(Rig::start(on(&fatal), clock).trouble().contains("needs repair"));
}

#[test]
fn a_port_that_another_has_is_busy() {
    let clock = HostClock::start();
    let pty = plugged(EmulatorConfig::default(), FaultsConfig::default(), swing, None, clock);
    let mut rig = Rig::start(on(&pty), clock);
    rig.poses(3);
    let told = Rig::start(on(&pty), clock).trouble();
    assert!(told.contains("in use by another program"), "{told}");
    rig.poses(3);
}

#[test]
fn a_file_is_no_serial_port() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let rig = Rig::start(Config { port: file.path().to_owned(), ..Config::default() }, HostClock::start());
    let told = rig.trouble();
    assert!(told.contains("is no serial port"), "{told}");
}
