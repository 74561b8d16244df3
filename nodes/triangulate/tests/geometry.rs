//! Points against the geometry that they come from.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use geometry::{Camera, LaserSheet};
use nalgebra::{Point2, Point3, Vector3};
use proptest::prelude::*;
use std::sync::LazyLock;
use triangulate::{Config, Triangulator, directions::Directions};
use wire::*;

fn camera() -> Camera {
    let distortion = [-0.084, 0.052, -0.0003, 0.0005, 0.0];
    Camera { width: 1280, height: 1024, fx: 1806.2, fy: 1805.3, cx: 634.8, cy: 517.4, distortion }
}

fn sheet() -> LaserSheet {
    LaserSheet::new(Vector3::new(-0.887, -0.007, 0.461), 0.0923).unwrap()
}

fn calibration() -> Calibration {
    let sheet = sheet();
    Calibration {
        header: Header::default(),
        camera: (&camera()).into(),
        laser: LaserPlane {
            normal: sheet.normal.into(),
            distance_m: sheet.distance_m,
            channel_weights: [1.0, 0.0, 0.0],
            peaks_per: PeaksPer::Row,
        },
        body_from_camera: RigidPose::IDENTITY,
        pose_offset_nanos: 0,
        name: String::new(),
    }
}

fn peak(pixel: Point2<f64>) -> StripePeak {
    let (u_px, v_px) = (pixel.x as f32, pixel.y as f32);
    StripePeak { u_px, v_px, sigma_px: 0.1, amplitude: 90.0, width_px: 1.5, flags: StripePeak::BEST }
}

fn stripe(peaks: Vec<StripePeak>) -> Stripe {
    Stripe {
        header: Header { stamp_nanos: 5, phase: Phase::Shape, ..Header::default() },
        width: 1280,
        height: 1024,
        light: Light { laser: true, lamp: false },
        peaks: Bulk(peaks),
        refused: vec![],
    }
}

/// Points of the sheet that the camera sees.
fn points_on_the_sheet() -> Vec<Point3<f64>> {
    let pixels =
        (0..40).flat_map(|i| (0..32).map(move |j| Point2::new(200.0 + 22.0 * f64::from(i), 32.0 * f64::from(j))));
    pixels
        .filter_map(|pixel| sheet().intersect(&camera().direction(pixel)))
        .filter(|p| p.z > 0.1 && p.z < 0.6)
        .collect()
}

#[test]
fn the_table_is_good_to_a_thousandth_of_a_pixel() {
    // A straight lens, a usual one, a strong barrel and a pincushion.
    for distortion in [[0.0; 5], camera().distortion, [-0.3, 0.12, 0.001, -0.001, -0.01], [0.25, 0.1, 0.0, 0.0, 0.0]] {
        let camera = Camera { fx: 900.0, fy: 905.0, distortion, ..camera() };
        camera.check().unwrap();
        let directions = Directions::new(&camera);
        for i in 0..2000 {
            let pixel = Point2::new(1279.0 * f64::from(i * 37 % 2000) / 2000.0, 1023.0 * f64::from(i) / 2000.0);
            let direction = directions.at(pixel.x as f32, pixel.y as f32).unwrap();
            let exact = camera.direction(pixel);
            let off_px = (f64::from(direction.xy[0]) - exact.x).hypot(f64::from(direction.xy[1]) - exact.y) * camera.fx;
            assert!(off_px < 1e-3, "{off_px} px at {pixel} with {distortion:?}");
        }
    }
}

#[test]
fn a_stripe_of_another_picture_gives_no_points() {
    let mut triangulator = Triangulator::new(Config::default(), &calibration()).unwrap();
    let other = Stripe { width: 640, ..stripe(vec![peak(Point2::new(600.0, 500.0))]) };
    let profile = triangulator.process(&other);
    assert!(profile.points.is_empty() && profile.refused[0].reason.contains("another size"));
}

#[test]
fn points_of_the_sheet_come_back_to_a_few_micrometres() {
    let mut triangulator = Triangulator::new(Config::default(), &calibration()).unwrap();
    let points = points_on_the_sheet();
    let profile = triangulator.process(&stripe(points.iter().map(|p| peak(camera().project(p).unwrap())).collect()));
    assert_eq!((profile.points.len(), profile.header.stamp_nanos), (points.len(), 5));
    for (found, truth) in profile.points.iter().zip(&points) {
        let off_m = (Point3::from(found.position_m).cast::<f64>() - truth).norm();
        assert!(off_m < 5e-6 * (truth.z / 0.2).powi(2), "{off_m} m at {truth}");
    }
}

#[test]
fn the_sigma_is_what_a_moved_peak_does() {
    let mut triangulator = Triangulator::new(Config::default(), &calibration()).unwrap();
    for truth in points_on_the_sheet() {
        let mut moved = peak(camera().project(&truth).unwrap());
        moved.u_px += moved.sigma_px;
        let profile = triangulator.process(&stripe(vec![moved]));
        let point = profile.points[0];
        let off = Point3::from(point.position_m).cast::<f64>() - truth;
        let along = off.dot(&truth.coords.normalize()).abs();
        assert!(
            (along / f64::from(point.range_sigma_m) - 1.0).abs() < 0.05,
            "{along} m, sigma {}",
            point.range_sigma_m
        );
    }
}

#[test]
fn what_gives_no_point_is_counted_by_reason() {
    let config = Config { near_mm: 150.0, far_mm: 250.0, ..Config::default() };
    let mut triangulator = Triangulator::new(config, &calibration()).unwrap();
    let not_chosen = StripePeak { flags: 0, ..peak(Point2::new(600.0, 500.0)) };
    let nan = StripePeak { u_px: f32::NAN, ..peak(Point2::new(600.0, 500.0)) };
    let off = peak(Point2::new(-900.0, 500.0));
    let far = peak(Point2::new(1279.0, 500.0));
    let profile = triangulator.process(&stripe(vec![not_chosen, nan, off, far]));
    assert!(profile.points.is_empty());
    let reasons: Vec<(&str, u64)> = profile.refused.iter().map(|r| (r.reason.as_str(), r.count)).collect();
    assert_eq!(reasons, [("peak that is not finite", 1), ("peak off the picture", 1), ("point too far", 1)]);
}

#[test]
fn impossible_settings_are_refused_by_name() {
    let config = Config { far_mm: 10.0, ..Config::default() };
    let refusal = Triangulator::new(config, &calibration()).unwrap_err().to_string();
    assert!(refusal.contains("far_mm = 10"), "{refusal}");
}

static ALL_PEAKS: LazyLock<Triangulator> =
    LazyLock::new(|| Triangulator::new(Config { best_only: false, ..Config::default() }, &calibration()).unwrap());

proptest! {
    #[test]
    fn any_peak_gives_a_finite_point_or_a_reason(u: f32, v: f32, sigma: f32, amplitude: f32, flags: u32) {
        let mut triangulator = ALL_PEAKS.clone();
        let hostile = StripePeak { u_px: u, v_px: v, sigma_px: sigma, amplitude, width_px: 1.0, flags };
        let profile = triangulator.process(&stripe(vec![hostile]));
        prop_assert_eq!(profile.points.len() as u64 + profile.refused.iter().map(|r| r.count).sum::<u64>(), 1);
        prop_assert!(profile.points.iter().all(|p| p.position_m.iter().all(|c| c.is_finite()) && p.range_sigma_m.is_finite()));
    }
}
