//! Every test vector of the manual and of its rules; and any bytes at all.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use serial_line::Emulated as _;
use tracker_flock::emulator::{EmulatorConfig, FlockEmulator, World};
use tracker_flock::protocol::address::addressed;
use tracker_flock::protocol::decoder::Decoder;
use tracker_flock::protocol::errors::{DeviceError, Severity};
use tracker_flock::protocol::examine::{Status, UnitStatus, error, model, rate_hz, revision};
use tracker_flock::protocol::reading::{NoReading, QuaternionSense, Reading, Scale, settle_sense, words_of};
use tracker_flock::protocol::records::{Format, Layout, MOST_WORDS, Record, decode_word, encode, encode_word};

fn record(format: Format, words: &[i16]) -> Record {
    let mut all = [0; MOST_WORDS];
    all[..words.len()].copy_from_slice(words);
    Record { format, words: all, button: 0, metal: 0, address: 0 }
}

fn decoded(bytes: &[u8], layout: Layout) -> Vec<Record> {
    let mut decoder = Decoder::new(layout);
    bytes.iter().filter_map(|&byte| decoder.push(byte)).collect()
}

const POSE_WORDS: [i16; 6] = [10923, -5461, 2731, 5461, -1820, 16384];
const MATRIX_WORDS: [i16; 9] = [27947, -4928, 16384, 16135, -2845, -28378, 5690, 32270, 0];
const ANGLES: [u8; 12] = [0xAA, 0x15, 0x2A, 0x75, 0x2A, 0x05, 0x55, 0x0A, 0x39, 0x7C, 0x00, 0x20];
const MATRIX: [u8; 24] = [
    0xAA, 0x15, 0x2A, 0x75, 0x2A, 0x05, 0x4A, 0x36, 0x30, 0x76, 0x00, 0x20, 0x41, 0x1F, 0x38, 0x7A, 0x49, 0x48, 0x0E,
    0x0B, 0x03, 0x3F, 0x00, 0x00,
];
const QUATERNION: [u8; 14] = [0xAA, 0x15, 0x2A, 0x75, 0x2A, 0x05, 0x43, 0x2A, 0x48, 0x2C, 0x6E, 0x07, 0x3D, 0x0F];

/// Azimuth 30, elevation -10, roll 90 degrees.
fn turned() -> UnitQuaternion<f64> {
    let [azimuth, elevation, roll] = [30.0, -10.0, 90.0].map(f64::to_radians);
    let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    about(Vector3::z_axis(), azimuth) * about(Vector3::y_axis(), elevation) * about(Vector3::x_axis(), roll)
}

#[test]
fn the_manuals_words() {
    for (words, bytes, back) in [
        ([4386, 13124, 21862], [0xC8, 0x08, 0x51, 0x19, 0x59, 0x2A], [4384, 13124, 21860]),
        ([0, 0, 0], [0x80, 0, 0, 0, 0, 0], [0, 0, 0]),
        ([-32768, 32767, -1], [0x80, 0x40, 0x7F, 0x3F, 0x7F, 0x7F], [-32768, 32764, -4]),
    ] {
        let layout = Layout::plain(Format::Position);
        assert_eq!(encode(&record(Format::Position, &words), &layout), bytes);
        assert_eq!(decoded(&bytes, layout)[0].used_words(), back);
    }
}

#[test]
fn the_same_pose_in_all_formats() {
    let angles = record(Format::PositionAngles, &POSE_WORDS);
    assert_eq!(encode(&angles, &Layout::plain(Format::PositionAngles)), ANGLES);
    let group = Layout { group: true, ..Layout::plain(Format::PositionAngles) };
    let in_group = encode(&Record { address: 2, ..angles }, &group);
    assert_eq!(in_group, [&ANGLES[..], &[0x02]].concat());
    let words: Vec<i16> = POSE_WORDS[..3].iter().chain(&MATRIX_WORDS).copied().collect();
    assert_eq!(encode(&record(Format::PositionMatrix, &words), &Layout::plain(Format::PositionMatrix)), MATRIX);

    let parts = [0.66446, 0.69636, 0.12279, 0.24184].map(|part: f64| (part * 32768.0).round() as i16);
    let words: Vec<i16> = POSE_WORDS[..3].iter().chain(&parts).copied().collect();
    let quaternion = Layout::plain(Format::PositionQuaternion);
    assert_eq!(encode(&record(Format::PositionQuaternion, &words), &quaternion), QUATERNION);

    let read = |bytes: &[u8], format| {
        Reading::of(&decoded(bytes, Layout::plain(format))[0], Scale::Inches36, QuaternionSense::AsMatrix).unwrap()
    };
    let position = Vector3::new(12.0, -6.0, 3.0) * 0.0254;
    for (bytes, format) in [
        (&ANGLES[..], Format::PositionAngles),
        (&MATRIX[..], Format::PositionMatrix),
        (&QUATERNION[..], Format::PositionQuaternion),
    ] {
        let reading = read(bytes, format);
        assert!((reading.position_m.unwrap() - position).abs().max() < 1.2e-4, "{format:?}");
        let angle = reading.rotation.unwrap().angle_to(&turned());
        assert!(angle < 5e-4, "{format:?}: {angle} rad from az 30, el -10, roll 90");
    }
    let double = Reading::of(
        &decoded(&ANGLES, Layout::plain(Format::PositionAngles))[0],
        Scale::Inches72,
        QuaternionSense::AsMatrix,
    );
    assert!((double.unwrap().position_m.unwrap() - 2.0 * position).abs().max() < 2.4e-4);
}

#[test]
fn the_smallest_step_is_four_counts_of_the_scale() {
    for (scale, step_mm) in [(Scale::Inches36, 0.1116), (Scale::Inches72, 0.2232), (Scale::Inches144, 0.4465)] {
        let at = |word| {
            let record = record(Format::PositionAngles, &[word, 0, 0, word, 0, 0]);
            Reading::of(&record, scale, QuaternionSense::AsMatrix).unwrap()
        };
        let (here, next) = (at(1000), at(1004));
        let moved = (next.position_m.unwrap() - here.position_m.unwrap()).norm() * 1e3;
        assert!((moved - step_mm).abs() < 1e-4, "{scale:?}: {moved} mm");
        let turned = next.rotation.unwrap().angle_to(&here.rotation.unwrap()).to_degrees();
        assert!((turned - 0.02197).abs() < 1e-5, "{turned} degrees");
    }
}

#[test]
fn what_follows_the_words_comes_in_its_order() {
    let layout = Layout { button: true, metal: true, group: true, ..Layout::plain(Format::PositionAngles) };
    let whole = Record { button: 0x30, metal: 17, address: 5, ..record(Format::PositionAngles, &POSE_WORDS) };
    let bytes = encode(&whole, &layout);
    assert_eq!(bytes[12..], [0x30, 17, 5]);
    let back = decoded(&bytes, layout)[0];
    assert_eq!((back.button, back.metal, back.address), (0x30, 17, 5));
}

#[test]
fn a_record_is_found_behind_any_ruin() {
    let layout = Layout::plain(Format::PositionAngles);
    let mut decoder = Decoder::new(layout);
    let mut feed = |bytes: &[u8]| bytes.iter().filter(|&&byte| decoder.push(byte).is_some()).count();
    assert_eq!(feed(&ANGLES), 1);
    assert_eq!(feed(&ANGLES[..7]), 0, "cut");
    assert_eq!(feed(&ANGLES), 1, "and whole again");
    assert_eq!(feed(&ANGLES[3..]), 0, "its head is lost");
    assert_eq!(feed(&ANGLES), 1);
    let tally = decoder.tally();
    assert_eq!((tally.records, tally.broken, tally.skipped_bytes), (3, 2, 7 + 9));
    assert_eq!(decoder.take_missed(), 2);
    assert_eq!(decoder.take_missed(), 0);
}

#[test]
fn what_is_no_measurement_is_refused() {
    let read = |record: &Record| Reading::of(record, Scale::Inches36, QuaternionSense::AsMatrix);
    assert_eq!(read(&record(Format::PositionAngles, &[0; 6])), Err(NoReading::Zeros));
    assert_eq!(read(&record(Format::PositionAngles, &[32764, 1, 1, 1, 1, 1])), Err(NoReading::FullScale));
    assert_eq!(read(&record(Format::PositionAngles, &[1, -32768, 1, 1, 1, 1])), Err(NoReading::FullScale));
    assert!(NoReading::Zeros.to_string().contains("too near the transmitter, or it is not plugged in"));
    assert!(NoReading::FullScale.to_string().contains("bring the sensor nearer, or choose a larger scale"));
    assert_eq!(read(&record(Format::PositionAngles, &[1, 1, 1, 1, 20000, 1])), Err(NoReading::NoRotation));
    assert_eq!(read(&record(Format::PositionMatrix, &[100; 12])), Err(NoReading::NoRotation));
    assert_eq!(read(&record(Format::Quaternion, &[100; 4])), Err(NoReading::NoRotation));
    let mut mirrored = MATRIX_WORDS;
    mirrored[..3].iter_mut().for_each(|word| *word = -*word);
    assert_eq!(read(&record(Format::Matrix, &mirrored)), Err(NoReading::NoRotation));
}

#[test]
fn the_quaternions_sense_is_settled_from_a_still_sensor() {
    let q = turned();
    assert_eq!(settle_sense(&q, &q), Some(QuaternionSense::AsMatrix));
    assert_eq!(settle_sense(&q, &q.inverse()), Some(QuaternionSense::Inverse));
    let identity = UnitQuaternion::identity();
    assert_eq!(settle_sense(&identity, &identity), None, "both senses look alike");
    let moved = UnitQuaternion::from_euler_angles(0.0, 0.2, 0.0) * q;
    assert_eq!(settle_sense(&q, &moved), None, "it moved between");
}

#[test]
fn answers_to_examine() {
    // Master, configured, running, position and matrix, streaming.
    let status = Status::of((0xD000u16 | 5 << 1 | 1).to_le_bytes());
    assert!(status.is_master() && status.is_configured() && status.runs() && status.streams());
    assert!(!status.has_error() && !status.sleeps() && !status.is_held());
    assert_eq!(status.format_code(), Format::PositionMatrix.status_code());
    assert!(Status::of([0x00, 0x20]).has_error());
    assert_eq!(revision([3, 67]), "3.67");
    assert!((rate_hz(((103.3f64 * 256.0) as u16).to_le_bytes()) - 103.3).abs() < 0.01);
    assert_eq!(model(b"6DFOB     "), "6DFOB");
    assert_eq!(model(b"6DERC\0\0\0\0\0"), "6DERC");
    let unit = UnitStatus(0xE1);
    assert!(unit.is_accessible() && unit.runs() && unit.has_sensor() && !unit.has_extended_range());
    assert_eq!(error([13, 4]), DeviceError { code: 13, detail: 4 });
}

#[test]
fn every_error_is_a_sentence() {
    for code in 0..=255 {
        let error = DeviceError { code, detail: 0 };
        assert!(!error.sentence().is_empty());
    }
    let severity = |code| DeviceError { code, detail: 0 }.severity();
    assert_eq!([1, 13, 6].map(severity), [Severity::Fatal, Severity::Warning, Severity::Note]);
}

#[test]
fn units_are_addressed_by_prefix() {
    assert_eq!(addressed(0, b"B"), b"B");
    assert_eq!(addressed(2, b"]"), [0xF2, b']']);
    assert_eq!(addressed(15, b"B"), [0xFF, b'B']);
    assert_eq!(addressed(16, b"B"), [0xE0, b'B']);
    assert_eq!(addressed(30, b"B"), [0xEE, b'B']);
    assert_eq!(addressed(77, b"B"), [0xA0, 77, b'B']);
}

fn formats() -> impl Strategy<Value = Layout> {
    (0..7usize, any::<[bool; 3]>()).prop_map(|(format, [button, metal, group])| Layout {
        format: Format::ALL[format],
        button,
        metal,
        group,
    })
}

proptest! {
    #[test]
    fn an_emulator_survives_any_host(bytes in prop::collection::vec(any::<u8>(), 0..400), units in 0u8..4) {
        let world: World = Box::new(|_, _| (Vector3::new(0.1, 0.2, 0.3), UnitQuaternion::identity()));
        let mut flock = FlockEmulator::new(EmulatorConfig { units, filters: true, ..EmulatorConfig::default() }, world);
        for (k, byte) in bytes.into_iter().enumerate() {
            flock.hear(&[byte], k as i64 * 3_000_000);
            while flock.speak(k as i64 * 3_000_000).is_some() {}
        }
    }

    #[test]
    fn words_come_back_without_their_low_bits(word: i16) {
        let [low, high] = encode_word(word);
        prop_assert!(low < 0x80 && high < 0x80);
        prop_assert_eq!(decode_word(low, high), word & !3);
    }

    #[test]
    fn poses_come_back(format in 0..7usize, x in -0.9..0.9f64, y in -0.9..0.9f64, turn in any::<[i16; 3]>(), inverse: bool) {
        let format = Format::ALL[format];
        let sense = if inverse { QuaternionSense::Inverse } else { QuaternionSense::AsMatrix };
        let position = Vector3::new(x, y, 0.5);
        let rotation = UnitQuaternion::new(Vector3::from(turn.map(|t| f64::from(t) / 1.1e4)));
        let layout = Layout::plain(format);
        let sent = words_of(format, Scale::Inches36, sense, &position, &rotation);
        let back = Reading::of(&decoded(&encode(&sent, &layout), layout)[0], Scale::Inches36, sense).unwrap();
        if let Some(p) = back.position_m {
            prop_assert!((p - position).abs().max() < 1.2e-4);
        }
        if let Some(r) = back.rotation {
            prop_assert!(r.angle_to(&rotation) < 1e-3, "{}", r.angle_to(&rotation));
        }
    }

    #[test]
    fn after_any_bytes_the_next_record_but_one_is_read(
        layout in formats(), garbage in prop::collection::vec(any::<u8>(), 0..300), turn in any::<[i16; 3]>(),
    ) {
        let rotation = UnitQuaternion::new(Vector3::from(turn.map(|t| f64::from(t) / 1.1e4)));
        let sent = words_of(layout.format, Scale::Inches36, QuaternionSense::AsMatrix, &Vector3::new(0.1, 0.2, 0.3), &rotation);
        let bytes = encode(&sent, &layout);
        let mut decoder = Decoder::new(layout);
        for byte in garbage {
            if let Some(record) = decoder.push(byte) {
                let _ = Reading::of(&record, Scale::Inches36, QuaternionSense::AsMatrix);
            }
        }
        let whole: Vec<Record> = bytes.iter().chain(&bytes).filter_map(|&byte| decoder.push(byte)).collect();
        let mut expected = sent;
        expected.words.iter_mut().for_each(|word| *word &= !3);
        prop_assert_eq!(whole.last().map(|r| r.words), Some(expected.words));
    }
}
