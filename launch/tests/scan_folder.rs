//! A recording with bad places in it becomes a scan folder of all the rest.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use formats::scan_folder::ScanFolder;
use geometry::Rig;
use limn::scan_folder::unpack;
use record::{Config, Recorder};
use std::path::{Path, PathBuf};
use wire::{Frame, Header, Light, Message, Phase, PixelFormat, Pose, Quality, codec, topic};

const PICTURES: i64 = 20;
const STEP_NANOS: i64 = 40_000_000;

fn put<M: Message>(recorder: &mut Recorder, topic: &topic::Topic<M>, message: &M) {
    let stamp_nanos = message.header().stamp_nanos;
    recorder.write(&topic.key, &codec::schema::<M>(), stamp_nanos, &codec::encode(message)).unwrap();
}

fn frame(header: Header) -> Frame {
    Frame {
        header,
        width: 40,
        height: 30,
        stride: 40,
        format: PixelFormat::Grey8,
        light: Light { laser: true, lamp: false },
        exposure_nanos: 0,
        gain: 1.0,
        gamma: 1.0,
        data: (0..1200u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect(),
    }
}

/// Twenty pictures and poses, and what does not belong there.
fn record(path: &Path) {
    let config = Config { chunk_s: 0.15, ..Config::default() };
    let mut recorder = Recorder::create(path, config, &Default::default()).unwrap();
    let rig = Path::new(env!("CARGO_MANIFEST_DIR")).join("../config/rigs/paper.toml");
    let rig = Rig::parse(&std::fs::read_to_string(rig).unwrap()).unwrap();
    recorder.write(&topic::calibration("head").key, "Calibration@999:1", 0, b"of another version").unwrap();
    let mut calibration = rig.calibration().unwrap();
    (calibration.camera.width, calibration.camera.height) = (40, 30);
    put(&mut recorder, &topic::calibration("head"), &calibration);
    for i in 0..PICTURES {
        let stamp_nanos = i * STEP_NANOS;
        let header = Header { phase: Phase::Shape, seq: i as u64, stamp_nanos, ..Header::default() };
        let (position_sigma_m, rotation_sigma_rad) = ([1e-3; 3], [1e-3; 3]);
        let pose = Pose { quality: Quality::Good, position_sigma_m, rotation_sigma_rad, ..Pose::none(header, "") };
        put(&mut recorder, &topic::pose("head"), &pose);
        put(&mut recorder, &topic::frame("head"), &frame(header));
        let (pose, frame_key) = (topic::pose("head").key, topic::frame("head").key);
        recorder.write(&pose, "Pose@999:1", stamp_nanos, b"of another version").unwrap();
        recorder.write(&frame_key, &codec::schema::<Frame>(), stamp_nanos, &[0xff; 40]).unwrap();
        let smaller = Frame { height: 31, ..frame(Header { stamp_nanos: stamp_nanos + 1, ..header }) };
        put(&mut recorder, &topic::frame("head"), &smaller);
    }
    recorder.finish().unwrap();
}

fn unpacked(damage: impl FnOnce(&mut [u8])) -> (tempfile::TempDir, PathBuf) {
    let place = tempfile::tempdir().unwrap();
    let (recording, folder) = (place.path().join("scan.mcap"), place.path().join("scan"));
    record(&recording);
    let mut bytes = std::fs::read(&recording).unwrap();
    damage(&mut bytes);
    std::fs::write(&recording, bytes).unwrap();
    unpack(&recording, &folder).unwrap();
    (place, folder)
}

#[test]
fn what_another_version_wrote_and_what_contradicts_itself_is_left_out() {
    let (_place, folder) = unpacked(|_| {});
    let scan = ScanFolder::open(&folder).unwrap();
    assert_eq!((scan.frames.len(), scan.poses.len()), (PICTURES as usize, PICTURES as usize));
    let seventh = scan.frame(7).unwrap().unwrap();
    assert_eq!((seventh.header.stamp_nanos, seventh.data.len()), (7 * STEP_NANOS, 1200));
}

#[test]
fn a_damaged_chunk_costs_no_more_than_itself() {
    let (_place, folder) = unpacked(|bytes| bytes[bytes.len() / 2] ^= 0x10);
    let scan = ScanFolder::open(&folder).unwrap();
    let (frames, poses) = (scan.frames.len(), scan.poses.len());
    // A chunk spans 0.15 s: four pictures.
    assert!((16..20).contains(&frames) && (16..20).contains(&poses), "{frames} pictures and {poses} poses");
    let last = scan.frames.last().unwrap().stamp_nanos;
    assert_eq!(last, (PICTURES - 1) * STEP_NANOS);
}
