//! Stamps, sigmas and quality, against a tracker that is played in no time at all.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

#[path = "../../serial_line/tests/harness/play.rs"]
mod harness;

use harness::{metres, pendulum, play, rms, stamp_errors_ms};
use nalgebra::{UnitQuaternion, Vector3};
use serial_line::{FaultsConfig, SensorPose};
use tracker_polhemus::emulator::{EmulatorConfig, PolhemusEmulator, World};
use tracker_polhemus::protocol::commands::{settings, stream};
use tracker_polhemus::protocol::decoder::Decoder;
use tracker_polhemus::protocol::errors::{is_well, sentence};
use tracker_polhemus::protocol::records::{Family, Layout};
use tracker_polhemus::{Config, PolhemusTracker};
use wire::Quality;

fn played(
    config: &Config,
    emulator: EmulatorConfig,
    faults: FaultsConfig,
    seconds: i64,
    world: impl Fn(i64) -> Vector3<f64> + Send + 'static,
) -> Vec<SensorPose> {
    let world: World = Box::new(move |_, nanos| (world(nanos), UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3)));
    let device = PolhemusEmulator::new(emulator, world);
    let mut decoder = Decoder::new(Layout::of(config.family));
    let decode = move |byte| decoder.push(byte).map(|record| (record, decoder.take_missed()));
    let told = settings(config).into_iter().chain(stream(config.family));
    play(device, told, faults, seconds, PolhemusTracker::new(config.clone()).unwrap(), decode)
}

fn config(family: Family, stations: &[u8]) -> Config {
    Config { family, stations: stations.to_vec(), ..Config::default() }
}

#[test]
fn stamps_are_true_to_half_a_millisecond_at_ten_milliseconds_of_jitter() {
    for (family, clock_rate) in
        [(Family::Fastrak, 1.0), (Family::Liberty, 1.0), (Family::Liberty, 1.00008), (Family::Patriot, 0.99995)]
    {
        for stations in [&[1u8][..], &[1, 2]] {
            let config = config(family, stations);
            let faults = FaultsConfig { seed: 7, jitter_nanos: 10_000_000, ..FaultsConfig::default() };
            let rate_hz = config.sheet().rate_hz;
            let emulator =
                EmulatorConfig { clock_rate, rate_hz, stations: stations.len() as u8, ..EmulatorConfig::of(family) };
            let poses = played(&config, emulator, faults, 20, pendulum);
            for sensor in 0..stations.len() {
                let rms = rms(&stamp_errors_ms(poses[600..].iter().filter(|pose| pose.sensor == sensor)));
                println!(
                    "{family:?}, clock {clock_rate}, station {} of {}: {rms:.3} ms rms",
                    sensor + 1,
                    stations.len()
                );
                assert!(rms < 0.5, "{family:?}, clock {clock_rate}, {} stations: {rms} ms rms", stations.len());
            }
            assert!(poses[600..].iter().all(|pose| pose.pose.quality == Quality::Good));
        }
    }
}

#[test]
fn sigma_and_quality_say_what_distance_distortion_and_the_device_do() {
    let at = |x: f64, change: fn(&mut EmulatorConfig)| {
        let mut emulator = EmulatorConfig::of(Family::Liberty);
        change(&mut emulator);
        let config = config(Family::Liberty, &[1]);
        played(&config, emulator, FaultsConfig::default(), 2, move |_| Vector3::new(x, 0.0, 0.0)).pop().unwrap().pose
    };
    let near = at(0.5, |_| {});
    assert_eq!((near.quality, near.reason.as_str()), (Quality::Good, ""));
    assert!((near.position_sigma_m[0] - 0.76e-3).abs() < 1e-9);
    let far = at(1.2, |_| {});
    assert!(far.quality == Quality::Degraded && far.reason.contains("1.20 m"));
    assert!((far.position_sigma_m[0] / 0.76e-3 - (1.2f64 / 0.9).powi(4)).abs() < 1e-3);
    let bent = at(0.5, |emulator| emulator.distortion = -300);
    assert!(bent.quality == Quality::Degraded && bent.reason.contains("level 300"));
    assert!((bent.rotation_sigma_rad[0] - 3.0 * 0.15f64.to_radians()).abs() < 1e-9);
    let well = at(0.5, |emulator| emulator.error = 0);
    assert_eq!(well.quality, Quality::Good, "binary records may say so with a zero");
}

#[test]
fn what_a_station_reports_is_a_sentence() {
    use Family::{Fastrak, Liberty, Patriot};
    for (family, error, why) in [
        (Fastrak, b'j', "reports `j`: the signal is saturated: the receiver is too near"),
        (Fastrak, b'k', "reports `k`: the signal is low: the receiver is too far from the source"),
        (Fastrak, b'l', "reports `l`: there is no signal"),
        (Fastrak, b'z', "reports `z`: see the errors in its manual"),
        (Liberty, b'c', "reports `c`: coils of the source fail: switch off, plug the source in firmly"),
        (Patriot, b'C', "reports `C`: coils of the source fail, and its own test has found errors"),
        (Liberty, b'I', "reports `I`: its own test has found errors"),
        (Patriot, b'u', "reports `u`: the sensor is outside of the part of the room"),
        (Liberty, 0x08, r"reports `\x08`: its sensors' processors do not answer"),
        (Patriot, 0x12, r"reports `\x12`: the source's own calibration cannot be read"),
        (Liberty, 0xFF, r"reports `\xff`: see the errors in its manual"),
    ] {
        let emulator = EmulatorConfig { error, ..EmulatorConfig::of(family) };
        let world = |_| Vector3::new(0.1, 0.0, 0.0);
        let ill = played(&config(family, &[1]), emulator, FaultsConfig::default(), 2, world).pop().unwrap().pose;
        assert!(ill.quality == Quality::Degraded && ill.reason.contains(why), "{family:?} {error:#x}: {}", ill.reason);
    }
}

#[test]
fn every_error_of_the_tables_says_what_to_do() {
    let known = |family| (0..=255).filter(move |error| sentence(family, *error).is_some()).collect::<Vec<u8>>();
    assert_eq!(known(Family::Fastrak), b"abcdefgjklmtuvwxy");
    let codes: Vec<u8> = (0x01..=0x18).chain(*b"ABCDEFGI").chain(*b"abcdefgu").collect();
    for family in [Family::Liberty, Family::Patriot] {
        assert_eq!(known(family), codes);
        assert!(is_well(family, 0) && is_well(family, b' ') && !is_well(family, b'a'));
    }
    assert!(!is_well(Family::Fastrak, 0));
    for family in [Family::Fastrak, Family::Liberty] {
        for error in known(family) {
            assert!(sentence(family, error).unwrap().contains(": "), "what has happened: what to do");
        }
    }
}

#[test]
fn lost_bytes_cost_the_records_they_are_in_and_no_stamp() {
    for family in [Family::Fastrak, Family::Liberty] {
        let faults = FaultsConfig {
            seed: 8,
            jitter_nanos: 5_000_000,
            lost_ppm: 1000,
            garbage_ppm: 5000,
            ..FaultsConfig::default()
        };
        let poses = played(&config(family, &[1]), EmulatorConfig::of(family), faults, 20, pendulum);
        let errors = stamp_errors_ms(poses[300..].iter().filter(|pose| pose.pose.quality == Quality::Good));
        let wrong = errors.iter().filter(|ms| **ms > 2.0).count();
        assert!(errors.len() > 1900 && wrong * 100 < errors.len(), "{family:?}: {wrong} of {}", errors.len());
    }
}

#[test]
fn a_sensor_is_followed_into_the_other_half_of_space() {
    let through = |nanos: i64| {
        let t = nanos as f64 * 1e-9;
        Vector3::new(0.3 * (1.5 * t).cos(), 0.2, 0.1 + 0.1 * t.sin())
    };
    for family in [Family::Fastrak, Family::Liberty] {
        let play = |config: &Config| played(config, EmulatorConfig::of(family), FaultsConfig::default(), 10, through);
        let off = |pose: &SensorPose| (metres(pose) - through(pose.pose.header.stamp_nanos)).norm();
        let poses = play(&config(family, &[1]));
        assert!(poses[50..].iter().all(|pose| off(pose) < 1e-3), "{family:?}");
        assert!(poses.iter().any(|pose| metres(pose).x < -0.25), "{family:?}");
        let as_told = play(&Config { follow_hemisphere: false, ..config(family, &[1]) });
        assert!(as_told.iter().all(|pose| metres(pose).x > -1e-3), "{family:?}: as the device has it");
        let by_itself = Config { follow_hemisphere: false, hemisphere: [0.0; 3], ..config(family, &[1]) };
        assert!(play(&by_itself)[50..].iter().all(|pose| off(pose) < 1e-3), "{family:?}: the device follows by itself");
    }
}

#[test]
fn a_device_that_changes_its_mind_about_the_half_of_space_is_not_believed() {
    for family in [Family::Fastrak, Family::Liberty] {
        let emulator = EmulatorConfig { flip_every_nanos: 700_000_000, ..EmulatorConfig::of(family) };
        let off = |pose: &SensorPose| (metres(pose) - pendulum(pose.pose.header.stamp_nanos)).norm();
        let poses = played(&config(family, &[1]), emulator.clone(), FaultsConfig::default(), 10, pendulum);
        assert!(poses[50..].iter().all(|pose| off(pose) < 2e-3), "{family:?}");
        let as_told = Config { follow_hemisphere: false, ..config(family, &[1]) };
        let poses = played(&as_told, emulator, FaultsConfig::default(), 10, pendulum);
        let flipped = poses.iter().filter(|pose| off(pose) > 0.1).count();
        assert!(
            (4 * poses.len()..6 * poses.len()).contains(&(10 * flipped)),
            "{family:?}: {flipped} of {}",
            poses.len()
        );
    }
}

#[test]
fn settings_that_cannot_be_are_refused_with_their_name() {
    let base = || config(Family::Patriot, &[1]);
    for (config, key) in [
        (Config { baud: 14_401, ..base() }, "baud"),
        (Config { stations: vec![], ..base() }, "stations"),
        (Config { stations: vec![3], ..base() }, "stations"),
        (Config { hemisphere: [f64::NAN, 0.0, 0.0], ..base() }, "hemisphere"),
        (Config { most_distortion: 0, ..base() }, "most_distortion"),
        (Config { latency_ms: Some(f64::INFINITY), ..base() }, "latency_ms"),
        (Config { port: "".into(), ..base() }, "port"),
    ] {
        assert_eq!(PolhemusTracker::new(config).unwrap_err().key, key);
    }
    assert!(serde_json::from_str::<Config>(r#"{"family": "fastrak", "stations": [1, 2]}"#).is_ok());
    assert!(serde_json::from_str::<Config>(r#"{"station": 1}"#).is_err());
}
