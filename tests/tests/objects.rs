//! Other people's things, each in another format, through the whole demo; and the paper's table top.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use geometry::TriangleMesh;
use image::{Rgb, RgbImage};
use nalgebra::Point3;
use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use system_tests::{limn, lost, number, quick_rig, report, succeed};

const ROWS: u32 = 48;
const COLUMNS: u32 = 96;

/// A pebble that stands on its flat side, closed, in units of nobody: 1.4 x 2 x 1. Its seam is there twice, as texture wants it.
fn pebble() -> TriangleMesh {
    let at = |row: u32, column: u32| {
        let (down, around) =
            (PI * f64::from(row) / f64::from(ROWS), TAU * f64::from(column % COLUMNS) / f64::from(COLUMNS));
        Point3::new(0.7 * down.sin() * around.cos(), down.sin() * around.sin(), 0.5 * down.cos()).cast::<f32>()
    };
    let places = || (0..=ROWS).flat_map(|row| (0..=COLUMNS).map(move |column| (row, column)));
    let number = |row: u32, column: u32| row * (COLUMNS + 1) + column;
    let square = |(row, column)| {
        let [a, b, c, d] =
            [number(row, column), number(row + 1, column), number(row + 1, column + 1), number(row, column + 1)];
        [[a, b, c], [a, c, d]]
    };
    let squares = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))).flat_map(square);
    // At the poles one of the two has no area.
    let has_area = |&[a, b, c]: &[u32; 3]| {
        let place = |i: u32| at(i / (COLUMNS + 1), i % (COLUMNS + 1));
        let [a, b, c] = [a, b, c].map(place);
        (b - a).cross(&(c - a)).norm() > 1e-6
    };
    TriangleMesh {
        vertices: places().map(|(row, column)| at(row, column)).collect(),
        uv: places().map(|(row, column)| [column as f32 / COLUMNS as f32, row as f32 / ROWS as f32]).collect(),
        triangles: squares.filter(has_area).collect(),
        ..TriangleMesh::default()
    }
}

/// Broad patches of two quiet colours.
fn patch(u: f32, v: f32) -> [u8; 3] {
    if ((6.0 * u).floor() + (3.0 * v).floor()) as i32 % 2 == 0 { [190, 160, 120] } else { [90, 120, 150] }
}

fn painted() -> TriangleMesh {
    let mut mesh = pebble();
    mesh.colours = mesh.uv.drain(..).map(|[u, v]| patch(u, v)).collect();
    mesh
}

fn textured() -> RgbImage {
    RgbImage::from_fn(192, 96, |x, y| Rgb(patch((x as f32 + 0.5) / 192.0, (y as f32 + 0.5) / 96.0)))
}

/// A short sweep over it.
fn scanned(out: &Path, arguments: &[&str]) -> serde_json::Value {
    let rig = quick_rig(out);
    let mut demo = limn();
    demo.args(["demo", "--headless", "--seconds", "10", "--rig"]).arg(rig).args(arguments).arg("--out").arg(out);
    succeed(&mut demo);
    let told = report(out);
    assert_eq!(lost(&told), 0);
    assert!(number(&told, "/counts/points") > 10_000.0);
    for file in ["truth.ply", "cloud.ply", "mesh.ply", "model.glb", "report.html"] {
        assert!(out.join(file).metadata().is_ok_and(|file| file.len() > 0), "{file}");
    }
    told
}

fn of_a_file(write: impl FnOnce(&Path) -> PathBuf) -> serde_json::Value {
    let folder = tempfile::tempdir().unwrap();
    let object = write(folder.path());
    let told = scanned(&folder.path().join("out"), &["--object", object.to_str().unwrap(), "--size-mm", "90"]);
    let median = number(&told, "/aligned/comparison/model_to_truth/median_mm");
    assert!(median < 0.2, "{median} mm");
    told
}

#[test]
fn a_textured_glb() {
    let told = of_a_file(|folder| {
        let path = folder.join("pebble.glb");
        formats::mesh::write_glb(&path, &pebble(), Some(&textured())).unwrap();
        path
    });
    let rms = number(&told, "/colour/rms_255");
    assert!(rms < 20.0, "{rms} of 255");
}

#[test]
fn a_coloured_ply() {
    let told = of_a_file(|folder| {
        let path = folder.join("pebble.ply");
        formats::mesh::write_ply(&path, &painted()).unwrap();
        path
    });
    let rms = number(&told, "/colour/rms_255");
    assert!(rms < 20.0, "{rms} of 255");
}

#[test]
fn an_stl_whose_colours_nobody_can_judge() {
    let told = of_a_file(|folder| {
        let path = folder.join("pebble.stl");
        formats::mesh::write_stl(&path, &pebble()).unwrap();
        path
    });
    assert!(told["colour"].is_null(), "{told:#}");
}

#[test]
fn the_cluttered_table_top_of_the_paper() {
    let folder = tempfile::tempdir().unwrap();
    let told = scanned(folder.path(), &["--scene", "tabletop"]);
    // So short a sweep is no measure of how good it gets.
    let median = number(&told, "/aligned/comparison/model_to_truth/median_mm");
    assert!(median < 1.0, "{median} mm");
}
