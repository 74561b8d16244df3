//! What is made of the streams before it is drawn.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use nalgebra::{Point3, Vector3};
use view::cloud::{CHUNK, ChunkedCloud};
use view::evidence::{Plotted, summary};
use view::handset::handset;
use view::picture::shrink;
use view::ways::Ways;
use wire::{
    Bulk, Cloud, CloudPoint, Extent, Frame, FrameFit, Header, LaserPlane, Light, Observed, PeaksPer, PixelFormat,
    Refinement, TrackerFit, Trajectory, TrajectorySample,
};

fn laser(normal: [f64; 3], distance_m: f64) -> LaserPlane {
    LaserPlane { normal, distance_m, channel_weights: [1.0, 0.0, 0.0], peaks_per: PeaksPer::Row }
}

#[test]
fn the_sheet_lies_in_the_lasers_plane_and_leaves_the_housing() {
    // The paper's rig: 26.6 degrees between sheet and axis, which it crosses at 0.2 m; the laser 0.10 m beside the camera.
    let plane = laser([-0.894398213, 0.008049584, 0.447199106], 0.089439821);
    let drawn = handset(&plane).unwrap();
    let normal = Vector3::from(plane.normal);
    for corner in drawn.sheet {
        let off = normal.dot(&Point3::from(corner).cast::<f64>().coords) - plane.distance_m;
        assert!(off.abs() < 1e-7, "{corner:?} is {off} m off");
    }
    let [exit, one, other] = drawn.sheet.map(Point3::from);
    assert!((exit.coords.norm() - 0.1).abs() < 1e-4, "{exit}");
    assert!(((one - other).norm() - 0.12).abs() < 1e-6 && nalgebra::center(&one, &other).coords.xy().norm() < 1e-4);
    let [middle, half] = drawn.housing.map(Vector3::from);
    for inside in [Vector3::zeros(), exit.coords] {
        assert!((inside - middle).abs().zip_map(&half, |d, h| h - d).min() > -1e-6, "{inside} is outside");
    }
}

#[test]
fn a_sheet_across_the_axis_is_not_drawn() {
    assert_eq!(handset(&laser([0.0, 0.0, 1.0], 0.2)), None);
    assert_eq!(handset(&laser([1.0, 0.0, 0.0], f64::NAN)), None);
}

fn way(scan: u64, revision: u32, samples: &[(i64, f64)]) -> Trajectory {
    let sample = |&(stamp_nanos, x): &(i64, f64)| TrajectorySample {
        stamp_nanos,
        translation_m: [x, 0.0, 0.0],
        rotation_wxyz: [1.0, 0.0, 0.0, 0.0],
        ..TrajectorySample::default()
    };
    let header = Header { scan, revision, ..Header::default() };
    Trajectory { header, samples: samples.iter().map(sample).collect::<Bulk<_>>() }
}

fn evidence(fits: &[(i64, f32)]) -> Refinement {
    let fit = |&(stamp_nanos, residual_m): &(i64, f32)| FrameFit { stamp_nanos, residual_m, sigma_m: 1e-5 };
    Refinement {
        header: Header::default(),
        residual_before_m: 0.0,
        residual_after_m: 0.0,
        pose_offset_error_nanos: 0,
        pose_offset_sigma_nanos: 0,
        rotation_lag_error_nanos: 0,
        rotation_lag_sigma_nanos: 0,
        tracker: TrackerFit { white_position_m: 1e-3, white_rotation_rad: 0.0, excess: None, inflation: 3.0 },
        hand_eye_freed: false,
        hand_eye_shift_m: [0.0; 3],
        hand_eye_turn_rad: [0.0; 3],
        hand_eye_shift_sigma_m: [0.0; 3],
        hand_eye_turn_sigma_rad: [0.0; 3],
        observed: None,
        notices: Vec::new(),
        frames: fits.iter().map(fit).collect::<Bulk<_>>(),
        misfits: Bulk::default(),
        unheld: Bulk::default(),
    }
}

#[test]
fn a_higher_revision_or_scan_starts_the_ways_afresh() {
    let mut ways = Ways::default();
    ways.tracker(&way(1, 0, &[(0, 0.0), (10, 1.0)]));
    ways.tracker(&way(1, 0, &[]));
    ways.refined(&way(1, 0, &[(0, 9.0)]));
    assert!(ways.by_refinement(1).is_empty(), "revision 0 is the tracker's");
    ways.refined(&way(1, 3, &[(0, 0.1), (10, 0.2)]));
    ways.refined(&way(1, 3, &[(20, 0.3)]));
    assert_eq!(ways.by_tracker(), [[1.0, 0.0, 0.0]]);
    assert_eq!(ways.by_refinement(2), [[0.1, 0.0, 0.0], [0.3, 0.0, 0.0]]);
    ways.refined(&way(1, 4, &[(0, 0.5)]));
    assert_eq!(ways.by_refinement(1), [[0.5, 0.0, 0.0]]);
    ways.tracker(&way(2, 0, &[(0, 7.0)]));
    assert_eq!(ways.by_tracker(), [[7.0, 0.0, 0.0]]);
    assert!(ways.by_refinement(1).is_empty());
}

#[test]
fn pictures_stand_on_the_refined_way_and_redden_as_they_misfit() {
    let mut ways = Ways::default();
    assert!(ways.pictures(&evidence(&[(0, 0.0)]).frames).is_empty(), "there is no way yet");
    ways.refined(&way(1, 1, &[(0, 0.0), (10, 0.1), (20, 0.2)]));
    let shown = ways.pictures(&evidence(&[(0, 0.0), (9, 1e-4), (20, 1.0), (15, f32::NAN), (21, 0.0)]).frames);
    let places: Vec<f32> = shown.iter().map(|(place, _)| place[0]).collect();
    assert_eq!(places, [0.0, 0.1, 0.2, 0.2], "the last is beyond the way");
    let [fits, half, worst, unknown] = [0, 1, 2, 3].map(|k| shown[k].1);
    assert!(fits[1] > fits[0] && half[0] > fits[0] && half[1] < fits[1] && worst[0] > worst[1]);
    assert!(unknown[0] == unknown[1] && unknown[1] == unknown[2]);
}

#[test]
fn each_picture_is_plotted_once_while_the_hand_moves_and_all_of_them_in_the_end() {
    let mut plotted = Plotted::default();
    let mut told = evidence(&[(0, 1e-4), (20, f32::NAN)]);
    told.misfits = vec![FrameFit { stamp_nanos: 30, residual_m: 2e-3, sigma_m: 1e-5 }].into();
    told.unheld = vec![FrameFit { stamp_nanos: 10, residual_m: f32::NAN, sigma_m: 3e-3 }].into();
    let stamps = |plotted: &mut Plotted, told: &Refinement| plotted.newer(told).map(|series| series.stamps_nanos);
    assert_eq!(
        stamps(&mut plotted, &told),
        [vec![0, 20], vec![0], vec![30], vec![10]],
        "what is not known is no value"
    );
    // One that was left out is kept now, one is new.
    told.misfits = Bulk::default();
    told.frames = evidence(&[(0, 1e-4), (20, 1e-4), (30, 1e-4), (40, 1e-4)]).frames;
    assert_eq!(stamps(&mut plotted, &told), [vec![40], vec![40], vec![], vec![]]);
    told.pose_offset_sigma_nanos = 1;
    let all = plotted.newer(&told);
    assert_eq!((all[0].values_mm.len(), all[3].stamps_nanos.clone()), (4, vec![10]));
    assert!((all[3].values_mm[0] - 3.0).abs() < 1e-6 && (all[1].values_mm[0] - 0.1).abs() < 1e-6, "millimetres");
    told.header.scan = 2;
    told.pose_offset_sigma_nanos = 0;
    assert_eq!(stamps(&mut plotted, &told)[0], [0, 20, 30, 40], "a new scan begins again");
}

#[test]
fn the_facts_tell_what_was_held_and_what_nobody_asked() {
    let mut told = evidence(&[(0, 1e-4)]);
    told.notices = vec!["strokes do not cross".to_owned()];
    let text = summary(&told);
    for fact in ["while the scan goes on", "**strokes do not cross**", "hand-eye shift | held", "not asked", "3 times"]
    {
        assert!(text.contains(fact), "{fact}: {text}");
    }
    assert!(!text.contains("crossed by stripes"));
    told.observed = Some(Observed { crossing: 0.42, stripes_along: [0.0, 0.0, 1.0], held_directions: 5 });
    (told.hand_eye_freed, told.hand_eye_shift_m, told.hand_eye_shift_sigma_m) = (true, [1e-3; 3], [1e-4; 3]);
    (told.pose_offset_error_nanos, told.pose_offset_sigma_nanos) = (-1_500_000, 250_000);
    (told.rotation_lag_error_nanos, told.rotation_lag_sigma_nanos) = (4_000_000, 500_000);
    let text = summary(&told);
    for fact in ["-1.50 \u{b1} 0.25 ms", "4.00 \u{b1} 0.50 ms", "1.73 \u{b1} 0.17 mm", "42 %", "5 of 6", "final"] {
        assert!(text.contains(fact), "{fact}: {text}");
    }
}

#[test]
fn of_the_cloud_only_what_changed_is_sent_again() {
    let ball = |id: u32| CloudPoint { id, count: 1, ..CloudPoint::default() };
    let cloud = |extent, ids: std::ops::Range<u32>| Cloud {
        header: Header::default(),
        extent,
        table: None,
        points: ids.map(ball).collect::<Bulk<_>>(),
        refused: Vec::new(),
    };
    let mut held = ChunkedCloud::default();
    let all = CHUNK as u32 + 10;
    held.take(&cloud(Extent::Whole, 0..all));
    let sizes: Vec<(usize, usize)> = held.changes().iter().map(|(number, balls)| (*number, balls.len())).collect();
    assert_eq!(sizes, [(0, CHUNK), (1, 10)]);
    held.take(&cloud(Extent::Changes, all - 1..all + 1));
    let sizes: Vec<(usize, usize)> = held.changes().iter().map(|(number, balls)| (*number, balls.len())).collect();
    assert_eq!(sizes, [(1, 11)]);
    assert!(held.changes().is_empty());
    // Of a ball that lost its points nothing is left.
    let mut gone = cloud(Extent::Changes, 3..4);
    gone.points[0].count = 0;
    held.take(&gone);
    assert_eq!(held.changes()[0].1.len(), CHUNK - 1);
    // A number out of the blue allocates nothing; what is gone from the whole is gone from the page.
    held.take(&cloud(Extent::Changes, u32::MAX - 1..u32::MAX));
    assert!(held.changes().is_empty());
    held.take(&cloud(Extent::Whole, 0..5));
    let sizes: Vec<(usize, usize)> = held.changes().iter().map(|(number, balls)| (*number, balls.len())).collect();
    assert_eq!(sizes, [(0, 5), (1, 0)]);
}

#[test]
fn a_thin_bright_line_survives_shrinking_and_a_frame_that_lies_is_refused() {
    let mut data = vec![10u8; 8 * 4];
    (0..4).for_each(|row| data[8 * row + 3] = 250);
    let frame = Frame {
        header: Header::default(),
        width: 8,
        height: 4,
        stride: 8,
        format: PixelFormat::Grey8,
        light: Light { laser: true, lamp: false },
        exposure_nanos: 0,
        gain: 1.0,
        gamma: 1.0,
        data: Bulk(data),
    };
    let small = shrink(&frame, 4).unwrap();
    assert_eq!((small.width, small.height, small.shrunk_by), (4, 2, 2));
    assert!(small.rgb.chunks(3).enumerate().all(|(k, pixel)| (pixel[0] == 250) == (k % 4 == 1)));
    assert_eq!(shrink(&Frame { height: 9, ..frame.clone() }, 4), None);
    let red = [81, 90, 81, 240].repeat(4 * 4);
    let yuyv = Frame { stride: 16, format: PixelFormat::Yuyv, data: Bulk(red), ..frame };
    assert_eq!(shrink(&yuyv, 4).unwrap().rgb[..3], [254, 0, 0]);
}
