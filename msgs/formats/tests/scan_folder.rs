//! Scan folders: ours there and back, and others' with every fault.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use formats::scan_folder::{POSITION_SIGMA_M, ScanFolder, ScanFolderWriter};
use geometry::Rig;
use proptest::prelude::*;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use wire::{Bulk, Frame, Header, Light, Phase, PixelFormat, Pose, Quality, RigidPose};

const RIG: &str = "name = \"bench\"\n[camera]\nwidth = 16\nheight = 8\nfx = 20.0\nfy = 20.0\ncx = 7.5\ncy = 3.5\n\
    [laser]\nnormal = [1.0, 0.0, 0.2]\ndistance_m = 0.05\nchannel_weights = [1.0, 0.0, 0.0]\npeaks_per = \"row\"\n\
    [body_from_camera]\ntranslation_m = [0.0, 0.0, 0.1]\nrotation_wxyz = [1.0, 0.0, 0.0, 0.0]\n";

fn frame(seq: u64, phase: Phase, light: Light, format: PixelFormat) -> Frame {
    let stride = format.row_bytes(16) as u32;
    Frame {
        header: Header { phase, seq, stamp_nanos: -20_000_001 + seq as i64 * 40_000_000, ..Header::default() },
        width: 16,
        height: 8,
        stride,
        format,
        light,
        exposure_nanos: 2_000_000,
        gain: 1.5,
        gamma: 2.2,
        data: Bulk((0..stride * 8).map(|i| (i * 7 % 256) as u8).collect()),
    }
}

fn pose(seq: u64, quality: Quality) -> Pose {
    Pose {
        header: Header {
            seq,
            phase: Phase::Both,
            stamp_nanos: 1_700_000_000_123_456_789 + seq as i64,
            ..Header::default()
        },
        world_from_body: RigidPose { translation_m: [0.1, -0.2, 1.0 / 3.0], rotation_wxyz: [0.6, 0.0, 0.8, 0.0] },
        position_sigma_m: [1e-3; 3],
        rotation_sigma_rad: [2e-3; 3],
        rotation_lag_nanos: 7_000_000,
        quality,
        reason: String::new(),
    }
}

#[test]
fn what_was_written_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let rig = Rig::parse(RIG).unwrap();
    let [laser, lamp] = [true, false].map(|laser| Light { laser, lamp: !laser });
    let frames = [
        frame(0, Phase::Shape, laser, PixelFormat::Grey8),
        frame(1, Phase::Both, laser, PixelFormat::Rgb8),
        frame(2, Phase::Both, lamp, PixelFormat::Rgb8),
    ];
    let poses = [pose(0, Quality::Good), pose(1, Quality::Good)];
    let mut writer = ScanFolderWriter::create(folder.path(), &rig).unwrap();
    frames.iter().for_each(|f| writer.frame(f).unwrap());
    poses.iter().for_each(|p| writer.pose(p));
    writer.pose(&pose(2, Quality::Lost));
    writer.save().unwrap();
    assert_eq!(writer.unusable_poses(), 1);

    let read = ScanFolder::open(folder.path()).unwrap();
    assert_eq!(read.rig, rig);
    let read_frames: Vec<Frame> = (0..3).map(|i| read.frame(i).unwrap().unwrap()).collect();
    assert_eq!(read_frames, frames);
    assert!(read.frame(3).is_none());
    let phase = Phase::Aim;
    let expected = poses.map(|p| Pose { header: Header { phase, ..p.header }, ..p });
    assert_eq!(read.poses, expected, "stamps to the nanosecond, numbers to the last bit");
    assert!(ScanFolderWriter::create(folder.path(), &rig).is_err(), "a scan is never overwritten");
}

#[test]
fn yuyv_is_written_in_colour() {
    for (format, red) in [(PixelFormat::Yuyv, [81, 90, 81, 240]), (PixelFormat::YuyvFull, [76, 85, 76, 255])] {
        let folder = tempfile::tempdir().unwrap();
        let mut writer = ScanFolderWriter::create(folder.path(), &Rig::parse(RIG).unwrap()).unwrap();
        let mut frame = frame(0, Phase::Colour, Light { laser: false, lamp: true }, format);
        frame.data = red.repeat(8 * 8).into();
        writer.frame(&frame).unwrap();
        writer.pose(&pose(0, Quality::Good));
        writer.save().unwrap();
        let read = ScanFolder::open(folder.path()).unwrap().frame(0).unwrap().unwrap();
        assert_eq!(read.format, PixelFormat::Rgb8);
        assert_eq!(&read.data[..3], [254, 0, 0], "BT.601 red, {format:?}");
    }
}

/// A good folder with one file replaced.
fn with(file: &str, text: &str) -> (TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| -> PathBuf { folder.path().join(name) };
    std::fs::create_dir(path("frames")).unwrap();
    image::GrayImage::new(16, 8).save(path("frames/a.png")).unwrap();
    image::GrayImage::new(9, 9).save(path("frames/small.png")).unwrap();
    std::fs::write(path("rig.toml"), RIG).unwrap();
    std::fs::write(path("frames.csv"), "stamp_s,phase,file\n0.5,shape,frames/a.png\n").unwrap();
    std::fs::write(path("poses.csv"), "stamp_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n").unwrap();
    if !file.is_empty() {
        std::fs::write(path(file), text).unwrap();
    }
    let complaint = match ScanFolder::open(folder.path()) {
        Err(error) => error.to_string(),
        Ok(scan) => scan.frame(0).unwrap().err().map_or(String::new(), |e| e.to_string()),
    };
    (folder, complaint)
}

#[test]
fn a_plain_folder_has_sane_defaults() {
    let (folder, complaint) = with("", "");
    assert_eq!(complaint, "");
    let scan = ScanFolder::open(folder.path()).unwrap();
    assert_eq!(scan.poses[0].position_sigma_m, [POSITION_SIGMA_M; 3]);
    let frame = scan.frame(0).unwrap().unwrap();
    assert_eq!((frame.light, frame.format), (Light { laser: true, lamp: false }, PixelFormat::Grey8));
    assert_eq!((frame.header.stamp_nanos, frame.header.phase, frame.gamma), (500_000_000, Phase::Shape, 1.0));
}

#[test]
fn faults_are_named_by_file_line_and_column() {
    const FRAMES: &str = "stamp_s,phase,file\n";
    const POSES: &str = "stamp_s,x_m,y_m,z_m,qw,qx,qy,qz\n";
    for (file, text, wanted) in [
        ("rig.toml", RIG.replace("fx", "focal"), "rig.toml: TOML parse error at line 5"),
        ("rig.toml", RIG.replace("20.0", "0.0"), "[camera] fx = 0: a focal length is at least 1 pixel"),
        ("frames.csv", FRAMES.into(), "frames.csv: lists no pictures"),
        ("frames.csv", "stamp_s,phase\n0,shape\n".into(), "frames.csv: line 1: column \"file\" is missing"),
        (
            "frames.csv",
            "stamp_s,phase,file,iso\n".into(),
            "unknown column \"iso\"; known are stamp_s, phase, file, light",
        ),
        ("frames.csv", format!("{FRAMES}now,shape,frames/a.png\n"), "line 2, column stamp_s: \"now\" is no time"),
        (
            "frames.csv",
            format!("{FRAMES}0,end,frames/a.png\n"),
            "line 2, column phase: \"end\" is not one of aim, shape",
        ),
        (
            "frames.csv",
            format!("{FRAMES}0,shape,frames/b.png\n"),
            "column file: \"frames/b.png\" is not there (looked for /",
        ),
        ("frames.csv", format!("{FRAMES}0,shape,frames/small.png\n"), "small.png: 9x9 pixels, but rig.toml says 16x8"),
        (
            "frames.csv",
            format!("{FRAMES}1,shape,frames/a.png\n1,shape,frames/a.png\n"),
            "line 3, column stamp_s: is not later",
        ),
        ("frames.csv", format!("{FRAMES}1,shape\n"), "line 2: has 2 columns where the first line names 3"),
        ("poses.csv", format!("{POSES}0,nan,0,0,1,0,0,0\n"), "poses.csv: line 2, column x_m: nan is not finite"),
        (
            "poses.csv",
            format!("{POSES}0,0,0,0,2,0,0,0\n"),
            "line 2, column qw: qw, qx, qy, qz have length 2.0000, not 1",
        ),
        ("poses.csv", format!("{POSES}0,0,,0,1,0,0,0\n"), "line 2, column y_m: is empty"),
        ("poses.csv", POSES.into(), "poses.csv: lists no poses"),
        ("frames/a.png", "no picture".into(), "a.png: "),
    ] {
        let (_folder, complaint) = with(file, &text);
        assert!(complaint.contains(wanted), "{file}: {complaint:?} does not say {wanted:?}");
    }
}

#[test]
fn the_real_scan_of_a_plate_is_read() {
    let etna = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/etna"));
    if !etna.exists() {
        // Past the test harness, which keeps to itself what a green test prints.
        let _ = writeln!(std::io::stderr(), "SKIPPED: {} is not there", etna.display());
        return;
    }
    let scan = ScanFolder::open(etna).unwrap();
    assert_eq!((scan.frames.len(), scan.poses.len(), scan.rig.name.as_str()), (16, 16, "etna"));
    for index in 0..16 {
        let frame = scan.frame(index).unwrap().unwrap();
        frame.check().unwrap();
        assert_eq!(frame.header.stamp_nanos, scan.poses[index].header.stamp_nanos);
    }
}

/// What may stand in a cell.
const CELLS: &[&str] = &[
    "",
    "0",
    "-1",
    "1",
    "0.5",
    "-0.0",
    "1e-300",
    "1e300",
    "1e999",
    "nan",
    "inf",
    "9223372036.9",
    "99999999999999999999",
    "shape",
    "colour",
    "both",
    "laser",
    "lamp",
    "good",
    "a.png",
    "../a.png",
    "\"",
    "\"a\"",
    "é",
    " ",
    "stamp_s",
    "# x",
];

/// A table of cells that are each good or odd.
fn table(columns: &'static [(&'static str, &'static str)]) -> impl Strategy<Value = String> {
    let odd = prop::option::weighted(0.1, prop::sample::select(CELLS));
    prop::collection::vec(prop::collection::vec(odd, columns.len()), 0..6).prop_map(move |rows| {
        let head: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
        let line = |(k, row): (usize, Vec<Option<&str>>)| {
            let cells = row
                .iter()
                .zip(columns)
                .map(|(odd, (_, good))| odd.map_or(good.replace("K", &k.to_string()), str::to_owned));
            cells.collect::<Vec<_>>().join(",")
        };
        let lines: Vec<String> = rows.into_iter().enumerate().map(line).collect();
        format!("{}\n{}\n", head.join(","), lines.join("\n"))
    })
}

const FRAME_COLUMNS: &[(&str, &str)] = &[
    ("stamp_s", "K.5"),
    ("phase", "shape"),
    ("file", "a.png"),
    ("light", "laser"),
    ("exposure_s", "0.002"),
    ("gain", "1"),
    ("gamma", "1"),
];
const POSE_COLUMNS: &[(&str, &str)] = &[
    ("stamp_s", "K.25"),
    ("x_m", "0.1"),
    ("y_m", "0"),
    ("z_m", "0.3"),
    ("qw", "1"),
    ("qx", "0"),
    ("qy", "0"),
    ("qz", "0"),
];

/// Opens, or says why not with the name of the file.
fn opens_or_names_the_file(frames: &[u8], poses: &[u8]) {
    let folder = tempfile::tempdir().unwrap();
    let tables = [("rig.toml", RIG.as_bytes()), ("a.png", b""), ("frames.csv", frames), ("poses.csv", poses)];
    tables.iter().for_each(|(name, bytes)| std::fs::write(folder.path().join(name), bytes).unwrap());
    match ScanFolder::open(folder.path()) {
        Ok(scan) => {
            assert!(scan.frames.windows(2).all(|pair| pair[0].stamp_nanos < pair[1].stamp_nanos));
            assert!(scan.poses.iter().all(|pose| geometry::rigid_from_wire(&pose.world_from_body).is_some()));
        }
        Err(error) => assert!(error.to_string().contains(".csv"), "{error}"),
    }
}

const GOOD_FRAMES: &str = "stamp_s,phase,file\n0.5,shape,a.png\n";
const GOOD_POSES: &str = "stamp_s,x_m,y_m,z_m,qw,qx,qy,qz\n0.5,0,0,0,1,0,0,0\n";

proptest! {
    #[test]
    fn odd_cells_of_frames_csv(frames in table(FRAME_COLUMNS)) {
        opens_or_names_the_file(frames.as_bytes(), GOOD_POSES.as_bytes());
    }

    #[test]
    fn odd_cells_of_poses_csv(poses in table(POSE_COLUMNS)) {
        opens_or_names_the_file(GOOD_FRAMES.as_bytes(), poses.as_bytes());
    }

    #[test]
    fn tables_of_garbage(frames in prop::collection::vec(any::<u8>(), 0..200), poses in prop::collection::vec(any::<u8>(), 0..200)) {
        opens_or_names_the_file(&frames, GOOD_POSES.as_bytes());
        opens_or_names_the_file(GOOD_FRAMES.as_bytes(), &poses);
    }
}
