//! Real pictures of a metal plate, from a robot-held camera and laser: stripe, triangulate and register in a row.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use formats::scan_folder::ScanFolder;
use nalgebra::{Matrix3, Point3, Vector3};
use register::{Config, Register};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use stripe::StripeDetector;
use triangulate::Triangulator;
use wire::{Pose, Scan};

/// Where the scan lies on the project's own machines; elsewhere it is not.
fn folder() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/etna");
    if !folder.join("rig.toml").is_file() {
        // Past the test harness, which keeps to itself what a green test prints.
        let _ = writeln!(std::io::stderr(), "SKIPPED: there is no {}", folder.display());
        return None;
    }
    Some(folder)
}

/// The least-squares plane: a point of it, and its unit normal.
fn plane(points: &[Point3<f64>]) -> (Point3<f64>, Vector3<f64>) {
    let centre = Point3::from(points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / points.len() as f64);
    let spread: Matrix3<f64> = points.iter().map(|p| (p - centre) * (p - centre).transpose()).sum();
    let eigen = spread.symmetric_eigen();
    (centre, eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned())
}

/// One scan a picture.
fn scans(folder: &Path) -> Vec<Scan> {
    let scan = ScanFolder::open(folder).unwrap();
    let calibration = scan.rig.calibration().unwrap();
    let mut detector = StripeDetector::new(stripe::Config::default(), &calibration.laser).unwrap();
    let mut triangulator = Triangulator::new(triangulate::Config::default(), &calibration).unwrap();
    let mut register = Register::new(Config::default(), &calibration).unwrap();
    for Pose { header, world_from_body, .. } in &scan.poses {
        assert!(geometry::rigid_from_wire(world_from_body).is_some(), "pose at {} ns", header.stamp_nanos);
    }
    scan.poses.iter().for_each(|pose| register.pose(pose));
    for index in 0..scan.frames.len() {
        let found = detector.process(&scan.frame(index).unwrap().unwrap()).unwrap();
        let best = found.peaks.iter().filter(|p| p.is_best()).count();
        let profile = triangulator.process(&found);
        println!("frame {index}: {best} best of {} peaks, {} points", found.peaks.len(), profile.points.len());
        for refusal in found.refused.iter().chain(&profile.refused) {
            println!("  {} x {}", refusal.count, refusal.reason);
        }
        register.profile(profile);
    }
    register.drain().collect()
}

#[test]
fn a_real_plate_comes_out_flat_and_where_it_is() {
    let Some(folder) = folder() else { return };
    let scans = scans(&folder);
    assert_eq!(scans.len(), 16);
    let points: Vec<Point3<f64>> =
        scans.iter().flat_map(|scan| scan.points.iter()).map(|p| Point3::from(p.position_m).cast()).collect();
    let mut near = points.clone();
    let (mut centre, mut normal) = plane(&near);
    for _ in 0..20 {
        near = points.iter().copied().filter(|p| (p - centre).dot(&normal).abs() < 1.5e-3).collect();
        (centre, normal) = plane(&near);
    }
    let rms_mm = 1e3 * (near.iter().map(|p| (p - centre).dot(&normal).powi(2)).sum::<f64>() / near.len() as f64).sqrt();
    let expected: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("expected.json")).unwrap()).unwrap();
    let known = &expected["with_poses_csv"]["plane_normal_world"];
    let known = Vector3::from([0, 1, 2].map(|axis| known[axis].as_f64().unwrap()));
    let off_deg = normal.dot(&known).abs().clamp(0.0, 1.0).acos().to_degrees();
    println!("{} of {} points near the plane, rms {rms_mm:.4} mm, {off_deg:.3} degrees off", near.len(), points.len());
    assert!(near.len() >= 15_500, "{} points", near.len());
    assert!(rms_mm <= 0.40, "{rms_mm} mm");
    assert!(off_deg <= 0.3, "{off_deg} degrees");
}
