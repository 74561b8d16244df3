//! Scan folders as messages.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use formats::scan_folder::{ScanFolder, ScanFolderWriter};
use geometry::Rig;
use replay::{FolderScan, Message, Names, ReplayError, Source};
use std::path::Path;
use wire::{Calibration, Frame, Header, Light, Phase, PixelFormat, Pose, Quality, RigidPose, topic};

const RIG: &str = "name = \"bench\"\n[camera]\nwidth = 16\nheight = 8\nfx = 20.0\nfy = 20.0\ncx = 7.5\ncy = 3.5\n\
    [laser]\nnormal = [1.0, 0.0, 0.2]\ndistance_m = 0.05\nchannel_weights = [1.0, 0.0, 0.0]\npeaks_per = \"row\"\n\
    [body_from_camera]\ntranslation_m = [0.0, 0.0, 0.1]\nrotation_wxyz = [1.0, 0.0, 0.0, 0.0]\n[clock]\npose_offset_s = 0.015\n";

fn write(folder: &Path) {
    let mut writer = ScanFolderWriter::create(folder, &Rig::parse(RIG).unwrap()).unwrap();
    for i in 0..4_i64 {
        let header = Header { phase: Phase::Both, seq: i as u64, stamp_nanos: i * 20_000_000, ..Header::default() };
        writer
            .frame(&Frame {
                header,
                width: 16,
                height: 8,
                stride: 16,
                format: PixelFormat::Grey8,
                light: Light { laser: i % 2 == 0, lamp: i % 2 == 1 },
                exposure_nanos: 0,
                gain: 1.0,
                gamma: 1.0,
                data: vec![i as u8; 16 * 8].into(),
            })
            .unwrap();
        writer.pose(&Pose {
            header,
            world_from_body: RigidPose::IDENTITY,
            position_sigma_m: [1e-3; 3],
            rotation_sigma_rad: [1e-3; 3],
            rotation_lag_nanos: 0,
            quality: Quality::Good,
            reason: String::new(),
        });
    }
    writer.save().unwrap();
}

#[test]
fn calibration_first_then_by_time_then_the_ends() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path());
    let scan = FolderScan::open(folder.path(), Names { camera: "left".into(), ..Names::default() }).unwrap();
    let messages: Vec<Message> = scan.messages().unwrap().collect::<Result<_, _>>().unwrap();
    let short = |m: &Message| {
        (m.key.as_str().split('/').next_back().unwrap().chars().next().unwrap(), m.stamp_nanos / 1_000_000)
    };
    // A pose is 15 ms later on the camera's clock.
    let order: Vec<(char, i64)> = messages.iter().map(short).collect();
    let expected = [
        ('c', 0),
        ('f', 0),
        ('p', 0),
        ('f', 20),
        ('c', 20),
        ('p', 20),
        ('f', 40),
        ('p', 40),
        ('f', 60),
        ('c', 60),
        ('p', 60),
        ('p', 60),
        ('f', 60),
        ('c', 60),
    ];
    assert_eq!(order, expected);
    assert_eq!(messages[0].decode::<Calibration>().unwrap().pose_offset_nanos, 15_000_000);
    let (told, colour) = (&messages[3], &messages[4]);
    assert_eq!((&told.key, &colour.key), (&topic::frame("left").key, &topic::colour("left").key));
    let (told, colour) = (told.decode::<Frame>().unwrap(), colour.decode::<Frame>().unwrap());
    assert!(told.light.lamp && told.data.is_empty());
    assert_eq!((colour.light.lamp, colour.data[0], colour.header.seq), (true, 1, 1));
    assert_eq!(messages[2].decode::<Pose>().unwrap().header.phase, Phase::Both);
    let ends = &messages[11..];
    assert!(ends[0].decode::<Pose>().unwrap().header.is_end() && ends[1].decode::<Frame>().unwrap().header.is_end());
    assert_eq!(ends[1].decode::<Frame>().unwrap().header.seq, 4);
}

#[test]
fn a_bad_picture_is_an_error_in_its_place() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path());
    std::fs::write(folder.path().join("frames/000002.png"), "no picture").unwrap();
    let source = Source::open(folder.path()).unwrap();
    let (good, bad): (Vec<_>, Vec<_>) = source.messages().unwrap().partition(Result::is_ok);
    assert_eq!((good.len(), bad.len()), (13, 1));
    assert!(matches!(bad[0], Err(ReplayError::Folder(_))));
}

#[test]
fn the_same_folder_plays_the_same_bytes_twice() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path());
    let play = || -> Vec<Message> { Source::open(folder.path()).unwrap().messages().unwrap().flatten().collect() };
    assert_eq!(play(), play());
    assert_eq!(ScanFolder::open(folder.path()).unwrap().frames.len(), 4);
}
