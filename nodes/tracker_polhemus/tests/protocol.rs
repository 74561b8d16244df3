//! Records as the public drivers know them; and any bytes at all.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use serial_line::Emulated as _;
use tracker_polhemus::Config;
use tracker_polhemus::emulator::{EmulatorConfig, PolhemusEmulator, World};
use tracker_polhemus::protocol::commands::{output_list, settings, stream};
use tracker_polhemus::protocol::decoder::Decoder;
use tracker_polhemus::protocol::records::{Family, Item, Layout, Record, encode};
use tracker_polhemus::protocol::status::FastrakStatus;

fn decoded(bytes: &[u8], layout: &Layout) -> Vec<Record> {
    let mut decoder = Decoder::new(layout.clone());
    bytes.iter().filter_map(|&byte| decoder.push(byte)).collect()
}

fn layout(family: Family, items: &[Item]) -> Layout {
    Layout { family, items: items.to_vec() }
}

fn record() -> Record {
    Record {
        station: 2,
        position_inches: [12.0, -6.5, 3.25],
        quaternion_wxyz: [0.5, -0.5, 0.5, 0.5],
        time_stamp_ms: 0x0001_0203,
        frame: 99,
        distortion: -7,
        ..Record::default()
    }
}

#[test]
fn a_fastraks_record_byte_for_byte() {
    let space = layout(Family::Fastrak, &[Item::Position, Item::Quaternion, Item::Space]);
    assert_eq!(space.bytes(), 32);
    let crlf = Layout::of(Family::Fastrak);
    assert_eq!(crlf.bytes(), 33);
    let mut bytes = b"02 ".to_vec();
    // 12, -6.5, 3.25 and 0.5, -0.5, 0.5, 0.5 as IEEE 754, low byte first.
    bytes.extend([0, 0, 0x40, 0x41, 0, 0, 0xD0, 0xC0, 0, 0, 0x50, 0x40]);
    bytes.extend([0, 0, 0, 0x3F, 0, 0, 0, 0xBF, 0, 0, 0, 0x3F, 0, 0, 0, 0x3F]);
    bytes.extend(b"\r\n");
    let plain = Record { time_stamp_ms: 0, frame: 0, distortion: 0, ..record() };
    assert_eq!(encode(&plain, &crlf), bytes);
    assert_eq!(decoded(&bytes, &crlf), [plain]);
    bytes[2] = b'a';
    assert_eq!(decoded(&bytes, &crlf)[0].error, b'a');
}

#[test]
fn a_libertys_records_have_the_lengths_that_drivers_know() {
    let vrpn = layout(Family::Liberty, &[Item::Position, Item::Quaternion, Item::TimeStamp, Item::Space]);
    assert_eq!((vrpn.bytes(), output_list(&vrpn).as_str()), (41, "2,7,8,0"));
    let items = [Item::TimeStamp, Item::FrameCount, Item::Distortion, Item::PositionPrecise, Item::Quaternion];
    let ros = layout(Family::Liberty, &items);
    assert_eq!((ros.bytes(), output_list(&ros).as_str()), (48, "8,9,11,3,7"));
    let bytes = encode(&record(), &ros);
    assert_eq!(bytes[..8], [b'L', b'Y', 2, b'C', b' ', 0, 40, 0]);
    assert_eq!(bytes[8..20], [0x03, 0x02, 0x01, 0x00, 99, 0, 0, 0, 0xF9, 0xFF, 0xFF, 0xFF]);
    assert_eq!(decoded(&bytes, &ros), [record()]);
    let patriot = encode(&record(), &Layout::of(Family::Patriot));
    assert_eq!(&patriot[..2], b"PA");
    assert_eq!(decoded(&patriot, &Layout::of(Family::Liberty)), [], "another device's");
}

#[test]
fn no_whole_record_is_lost_to_a_broken_one() {
    for family in [Family::Fastrak, Family::Liberty, Family::Patriot] {
        let layout = Layout::of(family);
        let bytes = encode(&Record { time_stamp_ms: 0, frame: 0, distortion: 0, ..record() }, &layout);
        let mut decoder = Decoder::new(layout.clone());
        let mut feed = |bytes: &[u8]| bytes.iter().filter(|&&byte| decoder.push(byte).is_some()).count();
        assert_eq!(feed(&bytes), 1);
        let mut lost_one = bytes.clone();
        lost_one.remove(20);
        assert_eq!(feed(&lost_one), 0, "{family:?}: a byte was lost");
        assert_eq!(feed(&bytes), 1, "{family:?}: and the next record is whole");
        assert_eq!(feed(&bytes[9..]), 0, "{family:?}: its head is lost");
        assert_eq!(feed(&bytes), 1);
        assert_eq!((decoder.tally().records, decoder.tally().broken), (3, 2));
        assert_eq!(decoder.take_missed(), 2);
    }
}

#[test]
fn what_cannot_be_is_no_record() {
    let layout = Layout::of(Family::Liberty);
    for wrong in [
        Record { quaternion_wxyz: [0.9, 0.9, 0.0, 0.0], ..record() },
        Record { quaternion_wxyz: [f32::NAN, 0.0, 0.0, 0.0], ..record() },
        Record { position_inches: [f32::INFINITY, 0.0, 0.0], ..record() },
        Record { position_inches: [1e9, 0.0, 0.0], ..record() },
    ] {
        assert_eq!(decoded(&encode(&wrong, &layout), &layout), []);
    }
}

#[test]
fn a_fastraks_status() {
    let text = format!("2 S003000      3.01  {:<32}\r\n", "3SPACE FASTRAK");
    let status = FastrakStatus::of(text.as_bytes()).unwrap();
    assert!(status.binary && status.centimetres && !status.continuous && status.self_test == 0);
    assert_eq!((status.firmware.as_str(), status.name.as_str()), ("3.01", "3SPACE FASTRAK"));
    assert_eq!(FastrakStatus::of(b"OK"), None);
    assert_eq!(FastrakStatus::of(&[0xFF; 55]), None);
}

/// What a device says within so many milliseconds to what it is told.
fn said(device: &mut PolhemusEmulator, told: &[u8], at_ms: i64, for_ms: i64) -> Vec<u8> {
    device.hear(told, at_ms * 1_000_000);
    let until = (at_ms + for_ms) * 1_000_000;
    std::iter::from_fn(|| device.speak(until)).flat_map(|(_, bytes)| bytes).collect()
}

fn played(family: Family, stations: u8) -> PolhemusEmulator {
    let world: World = Box::new(|_, _| (Vector3::new(0.1, 0.2, 0.3), UnitQuaternion::identity()));
    PolhemusEmulator::new(EmulatorConfig { stations, baud: 0, ..EmulatorConfig::of(family) }, world)
}

#[test]
fn a_fastrak_that_is_played_answers_as_drivers_know_it() {
    let mut device = played(Family::Fastrak, 2);
    let status = said(&mut device, b"S", 0, 0);
    assert_eq!((status.len(), &status[..3], &status[53..]), (55, &b"2 S"[..], &b"\r\n"[..]));
    assert_eq!(&status[3..9], b"000000", "text, inches, not continuous; no errors");
    assert_eq!(said(&mut device, b"l1\r", 1, 0), b"21l1100\r\n", "two stations are on");
    assert_eq!(said(&mut device, b"l1,0\rl2\r", 2, 0), b"22l0100\r\n");
    said(&mut device, b"fuC", 3, 0);
    assert_eq!(&said(&mut device, b"cS", 4, 0)[3..6], b"003", "binary and centimetres");
    assert_eq!(FastrakStatus::of(&status[..54]).unwrap().firmware, "3.01", "an IS-900 sends one byte less");
}

#[test]
fn what_starts_up_anew_has_forgotten_what_it_was_told() {
    for (family, told, restart) in
        [(Family::Fastrak, &b"O1,2,11,1\rf"[..], &b"\x19"[..]), (Family::Patriot, b"O1,2,7,8,11,1\rF1\r", b"\x19\r")]
    {
        let mut device = played(family, 1);
        let text = said(&mut device, b"P", 0, 0);
        assert!(text.starts_with(b"01 ") && text.ends_with(b"\r\n"), "text, until it is asked for more");
        said(&mut device, told, 1, 0);
        assert_eq!(said(&mut device, b"P", 2, 0).len(), Layout::of(family).bytes());
        said(&mut device, restart, 3, 0);
        assert!(said(&mut device, b"P", 9_000, 0).is_empty(), "it starts up for ten seconds");
        assert_eq!(said(&mut device, b"P", 10_100, 0), text);
    }
}

#[test]
fn the_set_up_is_a_list_of_commands() {
    let sent = |config: &Config| {
        let steps = settings(config).into_iter().chain(stream(config.family));
        steps.map(|step| String::from_utf8(step.send).unwrap()).collect::<String>()
    };
    let fastrak = Config { family: Family::Fastrak, stations: vec![1, 3], ..Config::default() };
    assert_eq!(
        sent(&fastrak),
        "Ul1,1\rl2,0\rl3,1\rl4,0\rO1,2,11,1\rH1,1,0,0\rO3,2,11,1\rH3,1,0,0\rx0,1,0,0\rv0,1,0,0\rfC"
    );
    let liberty = Config { filter: true, hemisphere: [0.0, 0.0, -1.0], ..Config::default() };
    assert_eq!(sent(&liberty), "U0\rR4\rO1,2,7,8,11,1\rH1,0,0,-1\rX0.2,0.2,0.8,0.8\rY0.2,0.2,0.8,0.8\rF1\rQ0\rC\r");
}

fn families() -> impl Strategy<Value = Family> {
    prop::sample::select(vec![Family::Fastrak, Family::Liberty, Family::Patriot])
}

proptest! {
    #[test]
    fn an_emulator_survives_any_host(family in families(), bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let world: World = Box::new(|_, _| (Vector3::new(0.1, 0.2, 0.3), UnitQuaternion::identity()));
        let mut device = PolhemusEmulator::new(EmulatorConfig::of(family), world);
        device.hear(b"C\r", 0);
        for (k, byte) in bytes.into_iter().enumerate() {
            device.hear(&[byte], k as i64 * 3_000_000);
            while device.speak(k as i64 * 3_000_000).is_some() {}
        }
    }

    #[test]
    fn after_any_bytes_the_next_record_but_one_is_read(
        family in families(), garbage in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        let layout = Layout::of(family);
        let bytes = encode(&record(), &layout);
        let mut decoder = Decoder::new(layout);
        let _ = garbage.iter().filter_map(|&byte| decoder.push(byte)).count();
        let found = bytes.iter().chain(&bytes).filter_map(|&byte| decoder.push(byte)).count();
        prop_assert!(found >= 1);
    }

    #[test]
    fn likely_garbage_is_survived(
        family in families(), garbage in prop::collection::vec(prop::sample::select(b"0LYPA1 \r\n\x01C.".to_vec()), 0..600),
    ) {
        let layout = Layout::of(family);
        let bytes = encode(&record(), &layout);
        let mut decoder = Decoder::new(layout);
        let _ = garbage.iter().filter_map(|&byte| decoder.push(byte)).count();
        let found = bytes.iter().chain(&bytes).filter_map(|&byte| decoder.push(byte)).count();
        prop_assert!(found >= 1);
    }
}

/// What this driver asks of each family, and other lists that end with a mark.
fn all_layouts() -> Vec<Layout> {
    use Item::{CrLf, Distortion, Euler, FrameCount, Position, PositionPrecise, Quaternion, Stylus, TimeStamp};
    let mut layouts = Vec::new();
    for family in [Family::Fastrak, Family::Liberty, Family::Patriot] {
        layouts.push(Layout::of(family));
        layouts.push(layout(family, &[Position, Euler, CrLf]));
        layouts.push(layout(family, &[Stylus, Position, Quaternion, CrLf]));
    }
    for family in [Family::Liberty, Family::Patriot] {
        layouts.push(layout(family, &[Distortion, FrameCount, TimeStamp, PositionPrecise, Quaternion, CrLf]));
    }
    layouts
}

/// Ten million bytes of anything, with whole records between: no panic, and each second record is found.
#[test]
fn ten_million_bytes_of_garbage() {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as u32
    };
    // With what records begin and end with, which is harder to tell from them.
    let likely = b"0LYPA12 \r\n\x01\x2cC.";
    let mut lines: Vec<(Decoder, Vec<u8>)> =
        all_layouts().into_iter().map(|layout| (Decoder::new(layout.clone()), encode(&record(), &layout))).collect();
    let (count, mut fed) = (lines.len(), 0);
    for burst in 0.. {
        let (decoder, bytes) = &mut lines[burst % count];
        let alike = burst / count % 2 == 1;
        for _ in 0..next() % 2000 {
            fed += 1;
            let byte = next();
            let _ = decoder.push(if alike { likely[byte as usize % likely.len()] } else { byte as u8 });
        }
        let found = bytes.iter().chain(&*bytes).filter_map(|&byte| decoder.push(byte)).count();
        assert!(found >= 1, "resynchronised within two records");
        if fed >= 10_000_000 && burst % count + 1 == count {
            break;
        }
    }
}
