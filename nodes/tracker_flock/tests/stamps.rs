//! Stamps, halves of space and sigmas, against a flock that is played in no time at all.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

#[path = "../../serial_line/tests/harness/play.rs"]
mod harness;

use harness::{metres, pendulum, play, rms, stamp_errors_ms};
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{FaultsConfig, SensorPose};
use tracker_flock::emulator::{EmulatorConfig, FlockEmulator, World};
use tracker_flock::protocol::commands::{settings, stream};
use tracker_flock::protocol::decoder::Decoder;
use tracker_flock::protocol::reading::QuaternionSense;
use tracker_flock::protocol::records::{Format, Layout};
use tracker_flock::{Config, FlockTracker, Heard};
use wire::Quality;

fn config() -> Config {
    Config { rate_hz: 100.0, ac_narrow_filter: false, output: Format::PositionAngles, ..Config::default() }
}

/// What the driver makes of so many seconds of a bird alone.
fn played(
    config: &Config,
    emulator: EmulatorConfig,
    faults: FaultsConfig,
    seconds: i64,
    world: impl Fn(i64) -> Vector3<f64> + Send + 'static,
) -> Vec<SensorPose> {
    let world: World = Box::new(move |_, nanos| (world(nanos), UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3)));
    let bird = FlockEmulator::new(emulator, world);
    let layout = Layout { metal: config.metal, ..Layout::plain(config.output) };
    let mut decoder = Decoder::new(layout);
    let decode = move |byte| {
        let record = decoder.push(byte)?;
        Some((Heard { record, layout, sense: QuaternionSense::AsMatrix }, decoder.take_missed()))
    };
    let told = settings(config).into_iter().chain(stream(config.report_every));
    play(bird, told, faults, seconds, FlockTracker::new(config.clone()).unwrap(), decode)
}

#[test]
fn stamps_are_true_to_half_a_millisecond_at_ten_milliseconds_of_jitter() {
    for (rate_hz, baud) in [(100.0, 115_200), (103.3, 38_400), (50.0, 19_200), (144.0, 115_200)] {
        let config = Config { rate_hz, baud, ..config() };
        let faults = FaultsConfig { seed: 7, jitter_nanos: 10_000_000, ..FaultsConfig::default() };
        let poses = played(&config, EmulatorConfig { baud, ..EmulatorConfig::default() }, faults, 20, pendulum);
        let rms = rms(&stamp_errors_ms(&poses[300..]));
        println!("{rate_hz} Hz, {baud} baud: {rms:.3} ms rms");
        assert!(rms < 0.3, "{rate_hz} Hz, {baud} baud: {rms} ms rms");
        assert!(poses[..20].iter().all(|pose| pose.pose.reason.contains("clock is not settled")));
        assert!(poses[300..].iter().all(|pose| pose.pose.quality == Quality::Good && pose.pose.reason.is_empty()));
    }
}

#[test]
fn stamps_are_as_true_when_only_some_of_the_measurements_are_sent() {
    for (report_every, seconds) in [(2, 20), (8, 40), (32, 120)] {
        let config = Config { report_every, ..config() };
        let faults = FaultsConfig { seed: 8, jitter_nanos: 10_000_000, ..FaultsConfig::default() };
        let poses = played(&config, EmulatorConfig::default(), faults, seconds, pendulum);
        let expected = seconds as usize * 100 / usize::from(report_every);
        assert!(poses.len().abs_diff(expected) <= 2, "every {report_every}.: {} of {expected}", poses.len());
        let stamps: Vec<i64> = poses.iter().map(|pose| pose.pose.header.stamp_nanos).collect();
        let step_ms = (stamps[stamps.len() - 1] - stamps[stamps.len() - 11]) as f64 * 1e-7;
        assert!((step_ms - 10.0 * f64::from(report_every)).abs() < 0.5, "every {report_every}.: {step_ms} ms");
        let rms = rms(&stamp_errors_ms(&poses[poses.len() / 2..]));
        println!("every {report_every}. of 100 Hz: {rms:.3} ms rms");
        assert!(rms < 1.5, "every {report_every}.: {rms} ms rms");
    }
}

#[test]
fn what_the_filters_against_the_mains_take_is_taken_off() {
    for (ac_narrow_filter, ac_wide_filter) in [(true, false), (false, true), (true, true)] {
        let config = Config { ac_narrow_filter, ac_wide_filter, ..config() };
        let poses = played(&config, EmulatorConfig::default(), FaultsConfig::default(), 8, pendulum);
        let rms = rms(&stamp_errors_ms(&poses[300..]));
        assert!(rms < 0.3, "narrow {ac_narrow_filter}, wide {ac_wide_filter}: {rms} ms rms");
    }
}

#[test]
fn lost_bytes_cost_the_records_they_are_in_and_no_stamp() {
    let faults =
        FaultsConfig { seed: 8, jitter_nanos: 5_000_000, lost_ppm: 1000, garbage_ppm: 5000, ..FaultsConfig::default() };
    let poses = played(&config(), EmulatorConfig::default(), faults, 30, pendulum);
    assert!(poses.len() > 2850, "{}", poses.len());
    // What garbage made up is no position of this pendulum.
    let real =
        poses[300..].iter().filter(|pose| (metres(pose).y - 0.05).abs() < 1e-3 && (metres(pose).z + 0.1).abs() < 1e-3);
    let errors = stamp_errors_ms(real);
    let wrong = errors.iter().filter(|ms| **ms > 2.0).count();
    assert!(wrong * 100 < errors.len(), "{wrong} of {} stamps are off by more than 2 ms", errors.len());
}

#[test]
fn a_sensor_is_followed_into_the_other_half_of_space() {
    let through = |nanos: i64| {
        let t = nanos as f64 * 1e-9;
        Vector3::new(0.3 * (1.5 * t).cos(), 0.2, 0.1 + 0.1 * t.sin())
    };
    let faults = FaultsConfig::default();
    let poses = played(&config(), EmulatorConfig::default(), faults, 10, through);
    let off = |pose: &SensorPose| (metres(pose) - through(pose.pose.header.stamp_nanos)).norm();
    assert!(poses.iter().all(|pose| off(pose) < 1e-3));
    assert!(poses.iter().any(|pose| metres(pose).x < -0.25));
    let as_told = Config { follow_hemisphere: false, ..config() };
    let poses = played(&as_told, EmulatorConfig::default(), faults, 10, through);
    assert!(poses.iter().all(|pose| metres(pose).x > -1e-3), "as the bird has it");
}

#[test]
fn a_bird_that_changes_its_mind_about_the_half_of_space_is_not_believed() {
    let emulator = EmulatorConfig { flip_every_nanos: 700_000_000, ..EmulatorConfig::default() };
    let off = |pose: &SensorPose| (metres(pose) - pendulum(pose.pose.header.stamp_nanos)).norm();
    let poses = played(&config(), emulator.clone(), FaultsConfig::default(), 10, pendulum);
    assert!(poses.iter().all(|pose| off(pose) < 2e-3), "what jumps through the transmitter is mirrored back");
    let as_told = Config { follow_hemisphere: false, ..config() };
    let poses = played(&as_told, emulator, FaultsConfig::default(), 10, pendulum);
    let flipped = poses.iter().filter(|pose| off(pose) > 0.1).count();
    assert!((400..600).contains(&flipped), "half the time it says the mirror image: {flipped} of {}", poses.len());
}

#[test]
fn sigma_and_quality_say_what_distance_and_metal_do() {
    let at = |x: f64, config: &Config, metal: u8| {
        let emulator = EmulatorConfig { metal, ..EmulatorConfig::default() };
        played(config, emulator, FaultsConfig::default(), 2, move |_| Vector3::new(x, 0.0, 0.01)).pop().unwrap().pose
    };
    let near = at(0.5, &config(), 0);
    assert_eq!(near.quality, Quality::Good);
    let far = at(0.9, &config(), 0);
    assert_eq!(far.quality, Quality::Degraded);
    assert!(
        (far.position_sigma_m[0] / 1.8e-3 - (0.9f64 / 0.762).powi(4)).abs() < 0.01 && far.reason.contains("0.90 m")
    );
    let beyond = at(1.2, &config(), 0);
    assert!(beyond.quality == Quality::Lost && beyond.reason.contains("larger scale"));
    let larger = Config { scale_inches: tracker_flock::protocol::reading::Scale::Inches72, ..config() };
    assert_eq!(at(1.2, &larger, 0).quality, Quality::Degraded);
    let metal = at(0.5, &Config { metal: true, ..config() }, 40);
    assert!(metal.quality == Quality::Degraded && metal.reason.contains("metal near"));
    assert!((metal.position_sigma_m[0] - 3.6e-3).abs() < 1e-9);
}

#[test]
fn the_adaptive_filter_is_late_in_motion_and_steady_at_rest() {
    let step = |nanos: i64| Vector3::new(if nanos < 2_000_000_000 { 0.3 } else { 0.302 }, 0.1, 0.1);
    let emulator = EmulatorConfig { filters: true, ..EmulatorConfig::default() };
    let poses = played(&config(), emulator, FaultsConfig::default(), 6, step);
    let after = |seconds: f64| {
        let at = poses.iter().find(|pose| pose.pose.header.stamp_nanos as f64 * 1e-9 > 2.0 + seconds).unwrap();
        (metres(at).x - 0.3) / 0.002
    };
    assert!(after(0.02) < 0.9 && after(3.0) > 0.9, "{} {}", after(0.02), after(3.0));
}

#[test]
fn the_adaptive_filter_is_later_the_farther_the_sensor_is() {
    // As the bird has it after power-up: 2 to 512 from the nearest range to the farthest.
    let config = Config { dc_motion: None, ..config() };
    let left = |x: f64| {
        let step = move |nanos: i64| Vector3::new(if nanos < 2_000_000_000 { x } else { x + 0.01 }, 0.1, 0.1);
        let emulator = EmulatorConfig { filters: true, ..EmulatorConfig::default() };
        let poses = played(&config, emulator, FaultsConfig::default(), 4, step);
        let at = poses.iter().find(|pose| pose.pose.header.stamp_nanos > 2_100_000_000).unwrap();
        1.0 - (metres(at).x - x) / 0.01
    };
    let [near, middle, far] = [0.3, 0.6, 0.85].map(left);
    assert!(2.0 * near < middle && 2.0 * middle < far, "a tenth of a second behind a step: {near} {middle} {far}");
}

#[test]
fn settings_that_cannot_be_are_refused_with_their_name() {
    for (config, key) in [
        (Config { baud: 14_400, ..config() }, "baud"),
        (Config { sensors: vec![2, 1], ..config() }, "sensors"),
        (Config { sensors: vec![15], ..config() }, "sensors"),
        (Config { sensors: vec![1, 2], units: 1, ..config() }, "units"),
        (Config { output: Format::Angles, ..config() }, "output"),
        (Config { line_frequency_hz: 55, ..config() }, "line_frequency_hz"),
        (Config { report_every: 3, ..config() }, "report_every"),
        (Config { rate_hz: f64::NAN, ..config() }, "rate_hz"),
        (Config { dc_alpha_max: Some([1.0; 7]), ..config() }, "dc_alpha_max"),
        (Config { port: "".into(), ..config() }, "port"),
    ] {
        assert_eq!(FlockTracker::new(config).unwrap_err().key, key);
    }
    assert!(serde_json::from_str::<Config>(r#"{"scale_inches": 72, "output": "position_quaternion"}"#).is_ok());
    assert!(serde_json::from_str::<Config>(r#"{"scale": 72}"#).is_err());
    assert!(serde_json::from_str::<Config>(r#"{"scale_inches": 40}"#).unwrap_err().to_string().contains("36 or 72"));
    let written = serde_json::to_string(&Config::default()).unwrap();
    assert_eq!(serde_json::from_str::<Config>(&written).unwrap(), Config::default());
}
