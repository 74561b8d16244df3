//! Released layouts never change: the bytes of one sample of every message are kept in tests/golden, with its schema.
//!
//! A message that is new, or has a new version, gets its file by `BLESS=1 cargo test -p wire --test golden`.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use std::fmt::Write as _;
use std::path::PathBuf;
use wire::*;

fn header() -> Header {
    Header { scan: 3, phase: Phase::Both, revision: 1, seq: 258, stamp_nanos: 1_234_567_890_123, clock: Clock::Scan }
}

fn pose() -> RigidPose {
    RigidPose { translation_m: [0.1, -0.2, 0.3], rotation_wxyz: [0.5, -0.5, 0.5, 0.5] }
}

fn refused() -> Vec<Refusal> {
    vec![Refusal { reason: "too wide".to_owned(), count: 7 }]
}

fn mesh() -> Mesh {
    Mesh {
        header: header(),
        vertices_m: Bulk(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
        normals: Bulk(vec![[0.0, 0.0, 1.0]; 3]),
        sigma_m: Bulk(vec![1e-4; 3]),
        triangles: Bulk(vec![[0, 1, 2]]),
    }
}

fn check<M: Message + PartialEq + std::fmt::Debug>(message: M) {
    let bytes = codec::encode(&message);
    assert_eq!(codec::decode::<M>(&bytes).unwrap(), message);
    let (head, tail) = codec::encode_apart(message.clone());
    assert!([head, tail].concat() == bytes, "in two parts it is the same");
    let mut hex = format!("{}\n", codec::schema::<M>());
    for (i, byte) in bytes.iter().enumerate() {
        write!(hex, "{byte:02x}{}", if i % 32 == 31 { "\n" } else { "" }).unwrap();
    }
    hex.push('\n');
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{}.hex", M::NAME));
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, &hex).unwrap();
    }
    let golden =
        std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}; BLESS=1 writes it", path.display()));
    assert_eq!(hex, golden, "the layout of {} has changed: give it a new version instead", M::NAME);
}

#[test]
fn what_a_source_sends() {
    check(Frame {
        header: header(),
        width: 2,
        height: 2,
        stride: 6,
        format: PixelFormat::Rgb8,
        light: Light { laser: true, lamp: false },
        exposure_nanos: 4_000_000,
        gain: 1.5,
        gamma: 2.2,
        data: Bulk((0..12).collect()),
    });
    check(Pose {
        header: header(),
        world_from_body: pose(),
        position_sigma_m: [1e-3, 2e-3, 3e-3],
        rotation_sigma_rad: [0.05, 0.06, 0.07],
        rotation_lag_nanos: -5,
        quality: Quality::Degraded,
        reason: "metal near".to_owned(),
    });
    check(Calibration {
        header: header(),
        camera: CameraIntrinsics {
            width: 640,
            height: 480,
            fx: 800.0,
            fy: 801.0,
            cx: 319.5,
            cy: 239.5,
            distortion: [0.1, 0.2, 0.3, 0.4, 0.5],
        },
        laser: LaserPlane {
            normal: [-0.8, 0.0, 0.6],
            distance_m: 0.1,
            channel_weights: [1.0, -0.25, -0.25],
            peaks_per: PeaksPer::Column,
        },
        body_from_camera: pose(),
        pose_offset_nanos: -3_000_000,
        name: "paper".to_owned(),
    });
    check(RunPhase { header: header(), discard: true });
}

#[test]
fn what_is_measured() {
    let peak = StripePeak {
        u_px: 1.5,
        v_px: 2.0,
        sigma_px: 0.1,
        amplitude: 90.0,
        width_px: 1.4,
        flags: StripePeak::BEST | StripePeak::SATURATED,
    };
    let light = Light { laser: true, lamp: true };
    check(Stripe { header: header(), width: 640, height: 480, light, peaks: Bulk(vec![peak]), refused: refused() });
    let point = ProfilePoint {
        position_m: [0.01, 0.02, 0.2],
        range_sigma_m: 1e-4,
        lateral_sigma_m: 2e-5,
        amplitude: 90.0,
        line: 17,
    };
    check(Profile { header: header(), points: Bulk(vec![point]), refused: refused() });
    let point = ScanPoint { position_m: [0.1, 0.2, 0.3], to_sensor: [0.0, 0.0, 1.0], sigma_m: 1e-4, amplitude: 90.0 };
    check(Scan {
        header: header(),
        world_from_camera: pose(),
        position_sigma_m: 1e-3,
        rotation_sigma_rad: 0.05,
        points: Bulk(vec![point]),
        refused: refused(),
    });
    let sample = TrajectorySample {
        stamp_nanos: 5,
        translation_m: [1.0, 2.0, 3.0],
        rotation_wxyz: [1.0, 0.0, 0.0, 0.0],
        position_sigma_m: 1e-3,
        rotation_sigma_rad: 0.05,
    };
    check(Trajectory { header: header(), samples: Bulk(vec![sample]) });
}

#[test]
fn what_is_modelled() {
    let ball = CloudPoint {
        position_m: [0.1, 0.2, 0.3],
        normal: [0.0, 0.0, 1.0],
        spread_m: 1e-4,
        sigma_m: 1e-5,
        count: 12,
        id: 345,
        colour: [10, 20, 30, 255],
    };
    check(Cloud { header: header(), extent: Extent::Whole, points: Bulk(vec![ball]), refused: refused() });
    check(mesh());
    check(Model {
        header: header(),
        mesh: mesh(),
        uv: Bulk(vec![[0.0, 0.5]; 3]),
        texture_width: 2,
        texture_height: 1,
        texture: Bulk(vec![[1, 2, 3, 255], [4, 5, 6, 85]]),
        cell_m: 1e-3,
    });
}

#[test]
fn what_nodes_say_of_themselves() {
    let input = InputHealth { key: "camera/head/frame".to_owned(), received: 10, lost: 1, refused: 2 };
    check(Health {
        header: header(),
        node: "stripe/head".to_owned(),
        inputs: vec![input],
        published: 9,
        refused: refused(),
        latency_p50_nanos: 3_000_000,
        latency_p99_nanos: 9_000_000,
        cpu_nanos: 123,
        busy_nanos: 456,
    });
    check(Progress { header: header(), node: "stripe/head".to_owned(), finished_seq: 258 });
    check(LogLine { header: header(), node: "stripe/head".to_owned(), level: LogLevel::Warn, text: "slow".to_owned() });
}
