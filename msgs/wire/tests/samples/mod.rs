//! One sample of every message, with every list filled: the bytes of these are held.

use wire::*;

/// What every message must have, or the tests do not compile.
pub trait Sample {
    /// The same each time.
    fn sample() -> Self;
}

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
        measured: 1,
    }
}

impl Sample for Frame {
    fn sample() -> Self {
        Frame {
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
        }
    }
}

impl Sample for Pose {
    fn sample() -> Self {
        Pose {
            header: header(),
            world_from_body: pose(),
            position_sigma_m: [1e-3, 2e-3, 3e-3],
            rotation_sigma_rad: [0.05, 0.06, 0.07],
            rotation_lag_nanos: -5,
            quality: Quality::Degraded,
            reason: "metal near".to_owned(),
        }
    }
}

impl Sample for Calibration {
    fn sample() -> Self {
        Calibration {
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
        }
    }
}

impl Sample for RunPhase {
    fn sample() -> Self {
        RunPhase { header: header(), discard: true }
    }
}

impl Sample for Stripe {
    fn sample() -> Self {
        let peak = StripePeak {
            u_px: 1.5,
            v_px: 2.0,
            sigma_px: 0.1,
            amplitude: 90.0,
            width_px: 1.4,
            flags: StripePeak::BEST | StripePeak::SATURATED,
        };
        let light = Light { laser: true, lamp: true };
        Stripe { header: header(), width: 640, height: 480, light, peaks: Bulk(vec![peak]), refused: refused() }
    }
}

impl Sample for Profile {
    fn sample() -> Self {
        let point = ProfilePoint {
            position_m: [0.01, 0.02, 0.2],
            range_sigma_m: 1e-4,
            lateral_sigma_m: 2e-5,
            amplitude: 90.0,
            line: 17,
        };
        Profile { header: header(), points: Bulk(vec![point]), refused: refused() }
    }
}

impl Sample for Scan {
    fn sample() -> Self {
        let point =
            ScanPoint { position_m: [0.1, 0.2, 0.3], to_sensor: [0.0, 0.0, 1.0], sigma_m: 1e-4, amplitude: 90.0 };
        Scan {
            header: header(),
            extent: Extent::Changes,
            world_from_camera: pose(),
            position_sigma_m: 1e-3,
            rotation_sigma_rad: 0.05,
            region_sigma_m: 2e-5,
            points: Bulk(vec![point]),
            refused: refused(),
        }
    }
}

impl Sample for Trajectory {
    fn sample() -> Self {
        let sample = TrajectorySample {
            stamp_nanos: 5,
            translation_m: [1.0, 2.0, 3.0],
            rotation_wxyz: [1.0, 0.0, 0.0, 0.0],
            position_sigma_m: 1e-3,
            rotation_sigma_rad: 0.05,
        };
        Trajectory { header: header(), samples: Bulk(vec![sample]) }
    }
}

impl Sample for Cloud {
    fn sample() -> Self {
        let ball = CloudPoint {
            position_m: [0.1, 0.2, 0.3],
            normal: [0.0, 0.0, 1.0],
            spread_m: 1e-4,
            sigma_m: 1e-5,
            count: 12,
            id: 345,
            colour: [10, 20, 30, 255],
        };
        let table = Some(TablePlane { normal: [0.0, 0.6, 0.8], distance_m: 0.75 });
        Cloud { header: header(), extent: Extent::Whole, table, points: Bulk(vec![ball]), refused: refused() }
    }
}

impl Sample for Mesh {
    fn sample() -> Self {
        mesh()
    }
}

impl Sample for Model {
    fn sample() -> Self {
        Model {
            header: header(),
            mesh: mesh(),
            uv: Bulk(vec![[0.0, 0.5]; 3]),
            texture_width: 2,
            texture_height: 1,
            texture: Bulk(vec![[1, 2, 3, 255], [4, 5, 6, 85]]),
            cell_m: 1e-3,
        }
    }
}

impl Sample for Health {
    fn sample() -> Self {
        let input = InputHealth { key: "camera/head/frame".to_owned(), received: 10, lost: 1, refused: 2 };
        Health {
            header: header(),
            node: "stripe/head".to_owned(),
            inputs: vec![input],
            published: 9,
            refused: refused(),
            latency_p50_nanos: 3_000_000,
            latency_p99_nanos: 9_000_000,
            latencies: Latencies { bins: vec![0, 3, 300, 70_000] },
            cpu_nanos: 123,
            busy_nanos: 456,
        }
    }
}

impl Sample for Progress {
    fn sample() -> Self {
        Progress { header: header(), node: "stripe/head".to_owned(), finished_seq: 258 }
    }
}

impl Sample for LogLine {
    fn sample() -> Self {
        LogLine { header: header(), node: "stripe/head".to_owned(), level: LogLevel::Warn, text: "slow".to_owned() }
    }
}

impl Sample for Refinement {
    fn sample() -> Self {
        let fit = FrameFit { stamp_nanos: 5, residual_m: 6e-5, sigma_m: 2e-5 };
        Refinement {
            header: header(),
            residual_before_m: 2e-3,
            residual_after_m: 1e-4,
            pose_offset_error_nanos: -15_000_000,
            pose_offset_sigma_nanos: 200_000,
            rotation_lag_error_nanos: 4_000_000,
            rotation_lag_sigma_nanos: 300_000,
            tracker: TrackerFit { white_position_m: 8e-4, white_rotation_rad: 0.03, excess: Some(0.7), inflation: 2.5 },
            hand_eye_freed: true,
            hand_eye_shift_m: [1e-3, -2e-3, 3e-3],
            hand_eye_turn_rad: [0.01, -0.02, 0.03],
            hand_eye_shift_sigma_m: [1e-4, 2e-4, 3e-4],
            hand_eye_turn_sigma_rad: [1e-3, 2e-3, 3e-3],
            observed: Some(Observed { crossing: 0.8, stripes_along: [0.0, 0.6, 0.8], held_directions: 6 }),
            notices: vec!["strokes do not cross".to_owned()],
            frames: Bulk(vec![fit; 2]),
            misfits: Bulk(vec![fit]),
            unheld: Bulk(vec![fit; 3]),
        }
    }
}
