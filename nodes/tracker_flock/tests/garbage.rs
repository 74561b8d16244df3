//! Any bytes at all, in every layout of records.

use nalgebra::{UnitQuaternion, Vector3};
use tracker_flock::protocol::decoder::Decoder;
use tracker_flock::protocol::reading::{QuaternionSense, Reading, Scale, words_of};
use tracker_flock::protocol::records::{Format, Layout, Record, encode};

/// All that a record may be: with button, metal and group byte, and without.
fn all_layouts() -> impl Iterator<Item = Layout> {
    Format::ALL.into_iter().flat_map(|format| {
        (0..8u8).map(move |bits| Layout { format, button: bits & 1 != 0, metal: bits & 2 != 0, group: bits & 4 != 0 })
    })
}

/// Ten million bytes of anything, with whole records between: no panic, and every record behind the garbage is found.
#[test]
fn ten_million_bytes_of_garbage() {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as u32
    };
    let (position, turn) = (Vector3::new(0.1, -0.2, 0.3), UnitQuaternion::from_euler_angles(0.3, 0.4, 0.5));
    let mut lines: Vec<(Decoder, Vec<u8>)> = all_layouts()
        .map(|layout| {
            let words = words_of(layout.format, Scale::Inches36, QuaternionSense::AsMatrix, &position, &turn);
            let sent = Record { button: 0x70, metal: 127, address: 126, ..words };
            (Decoder::new(layout), encode(&sent, &layout))
        })
        .collect();
    assert_eq!(lines.len(), 56);
    let mut fed = 0;
    for burst in 0.. {
        let which = burst % lines.len();
        let (decoder, bytes) = &mut lines[which];
        // Every other time around the phase bit is as seldom as in records.
        let seldom = burst / 56 % 2 == 1;
        for _ in 0..next() % 2000 {
            fed += 1;
            let byte = next();
            let byte = if seldom && byte & 0xF00 != 0 { byte & 0x7F } else { byte };
            if let Some(record) = decoder.push(byte as u8) {
                let _ = Reading::of(&record, Scale::Inches36, QuaternionSense::AsMatrix);
            }
        }
        let found = bytes.iter().filter_map(|&byte| decoder.push(byte)).count();
        assert_eq!(found, 1, "the first record behind the garbage is read");
        if fed >= 10_000_000 && which + 1 == lines.len() {
            break;
        }
    }
}
