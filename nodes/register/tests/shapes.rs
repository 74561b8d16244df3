//! Stripes on surfaces that are known exactly, through triangulate and register, against those surfaces.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod handset;

use handset::{FRAME_NANOS, POSE_NANOS, calibration, pose, stripe};
use nalgebra::{Point3, Vector3};
use register::{Config, Register};
use triangulate::Triangulator;
use wire::Scan;

const FRAMES: i64 = 50;

fn plane(p: &Point3<f64>) -> f64 {
    p.coords.dot(&Vector3::new(0.1, -0.05, 1.0).normalize()) - 0.004
}

fn sphere(p: &Point3<f64>) -> f64 {
    (p - Point3::new(0.0, 0.01, -0.03)).norm() - 0.06
}

fn cylinder(p: &Point3<f64>) -> f64 {
    let axis = Vector3::new(1.0, 0.4, 0.0).normalize();
    (p - Point3::new(0.0, 0.01, -0.02)).cross(&axis).norm() - 0.04
}

/// Numbers of unit variance that look random (Box and Muller over a Weyl sequence).
fn noise() -> impl FnMut() -> f64 {
    let mut i = 0.0;
    move || {
        i += 1.0;
        let (a, b) = ((i * 0.754_877_666_246_693_f64).fract(), (i * 0.569_840_290_998_053_f64).fract());
        (-2.0 * (1.0 - a).ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

fn scan(distance: impl Fn(&Point3<f64>) -> f64, sigma_px: f64) -> Vec<Scan> {
    let calibration = calibration();
    let mut triangulator = Triangulator::new(triangulate::Config::default(), &calibration).unwrap();
    let mut register = Register::new(Config::default(), &calibration).unwrap();
    let mut noise = noise();
    for i in 0..FRAMES {
        let stamp = i * FRAME_NANOS + 5_000_000;
        (0..4).for_each(|k| register.pose(&pose(i * FRAME_NANOS + k * POSE_NANOS)));
        register.profile(triangulator.process(&stripe(stamp, &distance, sigma_px, &mut noise)));
    }
    let scans: Vec<Scan> = register.drain().collect();
    assert_eq!(scans.len(), FRAMES as usize);
    assert!(scans.iter().all(|scan| scan.refused.is_empty()));
    scans
}

fn rms(values: impl Iterator<Item = f64> + Clone) -> f64 {
    (values.clone().map(|v| v * v).sum::<f64>() / values.count() as f64).sqrt()
}

fn check(distance: fn(&Point3<f64>) -> f64) {
    let truth = scan(distance, 0.0);
    let off = |scans: &[Scan]| -> Vec<f64> {
        scans.iter().flat_map(|s| s.points.iter()).map(|p| distance(&Point3::from(p.position_m).cast())).collect()
    };
    let exact = off(&truth);
    assert!(exact.len() > 2000, "{} points", exact.len());
    // What is left: poses that turn between two readings, and single precision.
    assert!(exact.iter().all(|d| d.abs() < 4e-6), "{:?}", exact.iter().map(|d| d.abs()).fold(0.0, f64::max));
    for sigma_px in [0.05, 0.1, 0.3] {
        let noisy = scan(distance, sigma_px);
        // Along the ray, from where the point would be without noise, in sigmas.
        let points = |scans: &[Scan]| scans.iter().flat_map(|scan| scan.points.0.clone()).collect::<Vec<_>>();
        let pulls: Vec<f64> = points(&noisy)
            .iter()
            .zip(points(&truth))
            .map(|(noisy, truth)| {
                let moved = Vector3::from(noisy.position_m) - Vector3::from(truth.position_m);
                f64::from(moved.dot(&Vector3::from(truth.to_sensor)) / noisy.sigma_m)
            })
            .collect();
        let (off_m, pull) = (rms(off(&noisy).into_iter()), rms(pulls.into_iter()));
        println!("{sigma_px} px: {} points, {:.4} mm rms, pull {pull:.2}", exact.len(), 1e3 * off_m);
        assert!((0.95..1.05).contains(&pull), "{sigma_px} px: {pull}");
        // A tenth of a pixel is 35 micrometres at most, with this sheet from this height.
        assert!(off_m < 0.4e-3 * sigma_px, "{sigma_px} px: {off_m} m");
    }
}

#[test]
fn a_plane_comes_out_flat() {
    check(plane);
}

#[test]
fn a_sphere_comes_out_round() {
    check(sphere);
}

#[test]
fn a_cylinder_comes_out_round() {
    check(cylinder);
}
