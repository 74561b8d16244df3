//! The line is where ray and sheet meet, as thick and as bright as it must be, and not where something is in its way.

use crate::bench::*;
use geometry::Rig;
use nalgebra::{Isometry3, Point2, Point3, Vector3};
use world::optics::{CameraModelSim, Workspace};
use world::{Scene, Surface};

fn truth(scene: &Scene, rig: &Rig) -> Vec<(f64, f64)> {
    let camera = CameraModelSim::new(scene, rig, 3).unwrap();
    camera.truth_stripe(&Isometry3::identity(), &mut Workspace::default())
}

/// Where the line must be in a row: on the ray's way the sheet and the plane meet at the same depth.
fn by_geometry(rig: &Rig, point: [f64; 3], normal: [f64; 3], row: f64) -> f64 {
    let (sheet, normal) = (rig.sheet().unwrap(), Vector3::from(normal));
    let apart = |column: f64| {
        let direction = rig.camera.direction(Point2::new(column, row));
        let on_plane = normal.dot(&Vector3::from(point)) / normal.dot(&direction);
        sheet.distance_to(&Point3::from(direction * on_plane))
    };
    let (mut low, mut high) = (0.0, 319.0);
    assert!(apart(low) * apart(high) < 0.0, "the line crosses row {row}");
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if apart(middle) * apart(low) > 0.0 { low = middle } else { high = middle }
    }
    low
}

/// Centre of gravity of the red light in a row, 6 px either way.
fn centre(frame: &wire::Frame, row: usize, about: f64) -> f64 {
    let first = (about - 6.0).round() as usize;
    let light = |column| value(frame, column, row, 0);
    let sum: f64 = (first..first + 13).map(light).sum();
    (first..first + 13).map(|column| column as f64 * light(column)).sum::<f64>() / sum
}

#[test]
fn a_plane_gives_the_line_where_ray_and_sheet_say() {
    let rig = rig(CLEAN);
    let planes = [
        ([0.0, 0.0, 0.2], [0.0, 0.0, -1.0]),
        ([0.0, 0.0, 0.2], [0.5, 0.3, -1.0]),
        ([0.0, 0.0, 0.23], [-0.4, 0.2, -1.0]),
    ];
    for (point, normal) in planes {
        let single = |p: [f64; 3]| p.map(|x| x as f32);
        let scene = scene(vec![plate(single(point), single(normal), 0.3)], 0.0);
        let frame = picture(&scene, &rig, LASER);
        let found = truth(&scene, &rig);
        let mut rows = 0;
        for &(u, v) in found.iter().filter(|(_, v)| (5.0..235.0).contains(v)) {
            let expected = by_geometry(&rig, point, normal, v);
            assert!((u - expected).abs() < 0.01, "truth: {u} for {expected} in row {v}");
            let seen = centre(&frame, v as usize, expected);
            assert!((seen - expected).abs() < 0.05, "picture: {seen} for {expected} in row {v}");
            rows += 1;
        }
        assert!(rows >= 229, "one crossing in each row, not {rows}");
    }
}

#[test]
fn the_line_is_as_long_as_the_fan_and_as_bright_as_stated() {
    let rig =
        rig(&CLEAN
            .replace("laser = {", "laser = { line_length_mm = 50, end_level = 1.0, level = 0.4, thickness_mm = 6,"));
    let scene = scene(vec![square_on(0.2)], 0.0);
    let rows = truth(&scene, &rig);
    // The source is 0.2236 m away from the line's middle, not 0.2 m.
    let expected = 50.0 / 200.0 * 0.2236 / 0.2 * 500.0;
    assert!((rows.len() as f64 - expected).abs() < 3.0, "{} rows for {expected}", rows.len());
    // Its ridge is far wider than the blur, so it keeps its level; the cosine and the distance take from it.
    let frame = picture(&scene, &rig, LASER);
    let (cosine, farther) = (0.2 / 0.2236, 0.2 / 0.2236);
    let (u, v) = rows[rows.len() / 2];
    let ridge = value(&frame, u.round() as usize, v as usize, 0) / 255.0;
    assert!((ridge / (0.4 * cosine * farther) - 1.0).abs() < 0.02, "{ridge}");
}

#[test]
fn what_stands_in_the_way_takes_the_line_and_leaves_a_shadow() {
    let rig = rig(CLEAN);
    let (wall, block) = (square_on(0.2), plate([-0.02, 0.0, 0.16], [0.0, 0.0, -1.0], 0.012));
    let source = Point3::new(-0.1, 0.0009, 0.0);
    let scene = scene(vec![wall, block], 0.0);
    let found = truth(&scene, &rig);
    let sheet = rig.sheet().unwrap();
    let (mut on_wall, mut on_block) = (0, 0);
    for &(u, v) in &found {
        let p = sheet.intersect(&rig.camera.direction(Point2::new(u, v))).unwrap();
        if (p.z - 0.2).abs() < 1e-4 {
            on_wall += 1;
            let at_block = source + (p - source) * (0.16 / p.z);
            assert!(!covered(&scene.surfaces[1], &at_block, -2e-4), "lit behind the block at row {v}");
        } else {
            assert!((p.z - 0.16).abs() < 1e-4, "on neither: {p}");
            assert!(covered(&scene.surfaces[1], &p, 2e-4));
            on_block += 1;
        }
    }
    assert!(on_wall > 100 && on_block > 30, "{on_wall} on the wall, {on_block} on the block");
    let frame = picture(&scene, &rig, LASER);
    let dark = (0..240).filter(|row| (0..320).all(|column| value(&frame, column, *row, 0) < 10.0)).count();
    assert_eq!(dark, 0, "each row has the wall's line or the block's");
}

/// Within the square of a plate that is grown by `margin` on all sides.
fn covered(surface: &Surface, p: &Point3<f64>, margin: f64) -> bool {
    let corners = &surface.mesh.vertices;
    let centre = nalgebra::center(&corners[0], &corners[2]).cast::<f64>();
    [1, 3].iter().all(|&i| {
        let side = (corners[i] - corners[0]).cast::<f64>();
        (p - centre).dot(&side.normalize()).abs() < 0.5 * side.norm() + margin
    })
}

#[test]
fn a_bright_line_saturates_and_stays_in_its_colours() {
    let rig = rig(&CLEAN.replace("laser = {", "laser = { level = 300,"));
    let frame = picture(&scene(vec![square_on(0.2)], 0.0), &rig, LASER);
    let top = |channel: usize| frame.data.iter().skip(channel).step_by(3).max().copied().unwrap();
    assert_eq!([top(0), top(1)], [255, 255]);
    assert!((100..255).contains(&top(2)), "2 % of the light: {}", top(2));
}

#[test]
fn speckle_has_the_stated_contrast_on_the_laser_alone() {
    // A line as thick as the picture is wide is flat across a few pixels.
    let contrast = 0.12;
    let noisy = CLEAN
        .replace("laser = { speckle_contrast = 0", "laser = { speckle_contrast = 0.12, thickness_mm = 8, level = 0.5");
    let scene = scene(vec![square_on(0.2)], 0.5);
    let (with, without) =
        (picture(&scene, &rig(&noisy), LASER), picture(&scene, &rig(&noisy.replace("0.12", "0")), LASER));
    let (mut sum, mut square, mut beside, mut count) = (0.0, 0.0, 0.0, 0.0);
    let background = value(&without, 20, 120, 0);
    let relative = |column: usize, row: usize| {
        (value(&with, column, row, 0) - value(&without, column, row, 0))
            / (value(&without, column, row, 0) - background)
    };
    for row in 10..230 {
        for column in 150..170 {
            let deviation = relative(column, row);
            sum += deviation;
            square += deviation * deviation;
            beside += deviation * relative(column + 1, row);
            count += 1.0;
        }
    }
    let sigma = (square / count - (sum / count) * (sum / count)).sqrt();
    assert!((sigma / contrast - 1.0).abs() < 0.08, "contrast {sigma}");
    assert!((0.3..0.8).contains(&(beside / square)), "neighbours are alike: {}", beside / square);
    for column in [20, 300] {
        assert_eq!(value(&with, column, 120, 0), value(&without, column, 120, 0), "the room's light has no speckle");
    }
}
