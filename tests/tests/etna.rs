//! Real pictures of a robot-held camera and laser, through the whole pipeline.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use nalgebra::{Matrix3, Point3, Vector3};
use std::path::Path;
use system_tests::{limn, report, shared_data, succeed};

/// Mean, unit normal and rms of the plane through points.
fn plane(points: &[Point3<f64>]) -> (Point3<f64>, Vector3<f64>) {
    let centre = points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / points.len() as f64;
    let spread = points.iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, p| {
        let d = p.coords - centre;
        sum + d * d.transpose()
    });
    let eigen = spread.symmetric_eigen();
    (Point3::from(centre), eigen.eigenvectors.column(eigen.eigenvalues.imin()).into())
}

/// Runs the folder through everything and holds its cloud against what is known of the plate: how many of its points lie
/// near the plane, and how many there are.
fn scanned(etna: &Path, sets: &[&str]) -> [usize; 2] {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("etna");
    succeed(limn().arg("model").arg(etna).arg("-o").arg(&out).args(sets.iter().flat_map(|set| ["--set", set])));
    let points = report(&out)["counts"]["points"].as_u64().unwrap();
    assert!(points >= 15_500, "{points} points");

    let cloud = formats::cloud::read(&out.join("cloud.ply")).unwrap();
    let mut near: Vec<Point3<f64>> = cloud.iter().map(|ball| Point3::from(ball.position_m).cast()).collect();
    let (mut centre, mut normal) = plane(&near);
    for _ in 0..10 {
        near.retain(|p| (p - centre).dot(&normal).abs() < 1.5e-3);
        (centre, normal) = plane(&near);
    }
    let rms_mm = 1e3 * (near.iter().map(|p| (p - centre).dot(&normal).powi(2)).sum::<f64>() / near.len() as f64).sqrt();
    let expected: serde_json::Value =
        serde_json::from_slice(&std::fs::read(etna.join("expected.json")).unwrap()).unwrap();
    let known = &expected["with_poses_csv"]["plane_normal_world"];
    let known = Vector3::from([0, 1, 2].map(|axis| known[axis].as_f64().unwrap()));
    let off_deg = normal.dot(&known).abs().clamp(0.0, 1.0).acos().to_degrees();
    println!("{points} points, {} near the plane, rms {rms_mm:.3} mm, normal {off_deg:.3} degrees off", near.len());
    assert!(rms_mm <= 0.40 && off_deg <= 0.3, "rms {rms_mm} mm, {off_deg} degrees");
    [near.len(), cloud.len()]
}

#[test]
fn a_real_scan_folder_of_a_plate_comes_out_flat() {
    let Some(etna) = shared_data("etna") else { return };
    // Balls so small that each holds about one point: what is judged is the points, not their averages.
    let [near, _] = scanned(&etna, &["cluster.ball_radius_m=0.00002", "cluster.least_points=1"]);
    assert!(near >= 15_500, "{near} points near the plane");
    // And as a user would run it.
    let [near, all] = scanned(&etna, &[]);
    assert!(near * 20 > all * 19, "{near} of {all} balls");
}
