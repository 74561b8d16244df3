//! The paper's rules (section 2.6), one by one.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod scene;

use nalgebra::{Point3, Vector3};
use paint::{Config, FrameRefusal, Painter};
use scene::*;
use wire::{Light, Mesh, Phase, PixelFormat, Refusal};

const PLATE: Shape = Shape::Plate { low: [-0.1; 2], high: [0.1; 2], z: 0.0 };
const EYE: [f64; 3] = [0.0, 0.0, 0.2];

fn painter(mesh: &Mesh) -> Painter {
    let mut painter = Painter::new(Config::default(), &calibration(&CAMERA)).unwrap();
    painter.mesh(mesh).unwrap();
    painter
}

fn large_plate() -> Mesh {
    plate_mesh([-0.1; 2], [0.1; 2], 0.0, 50)
}

fn count(refused: &[Refusal], reason: &str) -> u64 {
    refused.iter().filter(|r| r.reason.contains(reason)).map(|r| r.count).sum()
}

/// Places that were seen, by the model.
fn seen(painter: &Painter) -> Vec<(Point3<f64>, [f64; 4])> {
    places(&painter.model().0).into_iter().filter(|(_, colour)| colour[3] == 255.0).collect()
}

#[test]
fn only_within_15_degrees_of_the_axis() {
    let (mut painter, pose) = (painter(&large_plate()), look_at(EYE, [0.0; 3]));
    let report = painter.frame(&World::of(vec![(PLATE, white)]).frame(&CAMERA, &pose, 0), &pose).unwrap();
    let reach = 0.2 * 15f64.to_radians().tan();
    let expected = std::f64::consts::PI * (reach * 1e3).powi(2);
    assert!((report.coloured as f64 / expected - 1.0).abs() < 0.02, "{} {expected}", report.coloured);
    assert!(count(&report.refused, "optical axis") > 30_000);
    assert!(seen(&painter).iter().all(|(p, _)| p.coords.norm() < reach + 2e-3));
}

#[test]
fn only_surfaces_within_45_degrees_of_the_line_of_sight() {
    let world = World::of(vec![(PLATE, white)]);
    for lean in [20f64, 40.0, 50.0, 65.0] {
        let (sine, cosine) = lean.to_radians().sin_cos();
        let (mut painter, pose) = (painter(&large_plate()), look_at([0.2 * sine, 0.0, 0.2 * cosine], [0.0; 3]));
        let report = painter.frame(&world.frame(&CAMERA, &pose, 0), &pose).unwrap();
        let eye = Point3::from(pose.translation.vector);
        for (p, _) in seen(&painter) {
            let sight = (eye - p).normalize();
            assert!(sight.dot(&Vector3::z()) > 46f64.to_radians().cos(), "lean {lean}: {p}");
        }
        assert_eq!(report.coloured > 0, lean < 60.0, "lean {lean}: {}", report.coloured);
        assert_eq!(count(&report.refused, "steep") > 0, lean > 30.0, "lean {lean}");
    }
}

#[test]
fn no_surface_from_behind() {
    let (mut painter, pose) = (painter(&large_plate()), look_at([0.0, 0.0, -0.2], [0.0; 3]));
    let report = painter.frame(&World::of(vec![(PLATE, white)]).frame(&CAMERA, &pose, 0), &pose).unwrap();
    assert_eq!(report.coloured, 0);
}

#[test]
fn saturated_pixels_colour_nothing() {
    let mut world = World::of(vec![(PLATE, checker)]);
    world.exposure = 1.55;
    let (mut painter, pose) = (painter(&large_plate()), look_at(EYE, [0.0; 3]));
    let report = painter.frame(&world.frame(&CAMERA, &pose, 0), &pose).unwrap();
    assert!(count(&report.refused, "saturated") > 500);
    // The orange checks are too bright in red, at least near the axis: what was seen there is blue.
    let seen: Vec<_> = seen(&painter).into_iter().filter(|(p, _)| p.coords.norm() < 0.03).collect();
    assert!(seen.len() > 30, "{}", seen.len());
    for (p, colour) in seen {
        assert!(colour[2] > colour[0], "{p} {colour:?}");
    }
}

/// A white plate before a black plane, close or far: nothing of it lands on the plane.
#[test]
fn no_colour_lands_behind_what_hides_it() {
    for (gap, views) in [(0.0015, 1), (0.01, 1), (0.05, 1), (0.05, 5)] {
        let plate = Shape::Plate { low: [-0.01, -0.02], high: [0.01, 0.02], z: gap };
        let mut world = World::of(vec![(PLATE, black), (plate, white)]);
        world.exposure = 0.4;
        let front = plate_mesh([-0.01, -0.02], [0.01, 0.02], gap as f32, 10);
        let mut painter = painter(&join(&large_plate(), &front));
        let mut refused = 0;
        for i in 0..views {
            let pose = look_at([0.03 * f64::from(i), 0.02, 0.2], [0.02 * f64::from(i), 0.0, 0.0]);
            let report = painter.frame(&world.frame(&CAMERA, &pose, i as u64), &pose).unwrap();
            refused += count(&report.refused, "hidden") + count(&report.refused, "edge");
        }
        assert!(refused > 100, "gap {gap}: {refused}");
        let seen = seen(&painter);
        let (plane, plate): (Vec<_>, Vec<_>) = seen.iter().partition(|(p, _)| p.z < 0.5 * gap);
        assert!(plane.len() > 300 && plate.len() > 50, "gap {gap}: {} and {}", plane.len(), plate.len());
        let brightest = plane.iter().map(|(_, c)| c[1]).fold(0.0, f64::max);
        let darkest = plate.iter().map(|(_, c)| c[1]).fold(255.0, f64::min);
        assert!(brightest < 60.0 && darkest > 190.0, "gap {gap}, {views} views: {brightest} {darkest}");
        if views == 1 {
            let hidden = plane.iter().filter(|(p, _)| p.x.abs() < 0.009 && p.y.abs() < 0.015).count();
            assert_eq!(hidden, 0, "gap {gap}");
        }
    }
}

#[test]
fn a_curved_surface_does_not_hide_itself() {
    let mesh = sphere_mesh([0.0; 3], 0.03, 30);
    let world = World::of(vec![(Shape::Sphere { centre: Point3::origin(), radius: 0.03 }, white)]);
    let (mut painter, pose) = (painter(&mesh), look_at([0.0, 0.0, 0.23], [0.0; 3]));
    let report = painter.frame(&world.frame(&CAMERA, &pose, 0), &pose).unwrap();
    assert_eq!(count(&report.refused, "hidden"), 0);
    assert_eq!(count(&report.refused, "edge"), 0);
    assert!(report.coloured > 1000);
}

#[test]
fn only_frames_lit_by_the_lamp() {
    let (mut painter, pose) = (painter(&large_plate()), look_at(EYE, [0.0; 3]));
    let good = frame_of(&CAMERA, vec![100; 3 * 640 * 512], 0);
    let mut refused = |change: &dyn Fn(&mut wire::Frame)| {
        let mut frame = good.clone();
        change(&mut frame);
        painter.frame(&frame, &pose).map(|_| ())
    };
    assert_eq!(refused(&|_| ()), Ok(()));
    assert_eq!(refused(&|f| f.header.phase = Phase::Both), Ok(()));
    assert_eq!(refused(&|f| f.light.lamp = false), Ok(()), "the colour phase may do with ambient light");
    assert_eq!(refused(&|f| f.light = Light { laser: true, lamp: true }), Err(FrameRefusal::Laser));
    assert_eq!(refused(&|f| f.header.phase = Phase::Aim), Err(FrameRefusal::Phase));
    assert_eq!(refused(&|f| f.header.phase = Phase::End), Err(FrameRefusal::Phase));
    let unlit = |f: &mut wire::Frame| (f.header.phase, f.light.lamp) = (Phase::Both, false);
    assert_eq!(refused(&unlit), Err(FrameRefusal::Unlit));
    assert_eq!(refused(&|f| f.data.truncate(1000)), Err(FrameRefusal::Malformed));
    assert_eq!(refused(&|f| f.stride = 3), Err(FrameRefusal::Malformed));
    let small = |f: &mut wire::Frame| (f.height, f.data) = (100, vec![0; 3 * 640 * 100].into());
    assert_eq!(refused(&small), Err(FrameRefusal::Size));
    for bad in [f32::NAN, 0.0, -1.0, f32::INFINITY] {
        assert_eq!(refused(&|f| f.gain = bad), Err(FrameRefusal::Response));
        assert_eq!(refused(&|f| f.gamma = bad), Err(FrameRefusal::Response));
    }
    let lost = look_at([f64::NAN; 3], [0.0; 3]);
    assert_eq!(painter.frame(&good, &lost).map(|_| ()), Err(FrameRefusal::Pose));
    assert_eq!(painter.refused_frames().iter().map(|r| r.count).sum::<u64>(), 16);
}

#[test]
fn grey_and_yuyv_pictures_are_read_in_place() {
    let pose = look_at(EYE, [0.0; 3]);
    let pixels = 640 * 512;
    for (format, bytes, stride) in [
        (PixelFormat::Grey8, vec![120; pixels], 640),
        (PixelFormat::Yuyv, [119, 128, 119, 128].repeat(pixels / 2), 1280),
        (PixelFormat::YuyvFull, [119, 128, 119, 128].repeat(pixels / 2), 1280),
    ] {
        let mut painter = painter(&large_plate());
        let frame = wire::Frame { format, stride, ..frame_of(&CAMERA, bytes, 0) };
        assert!(painter.frame(&frame, &pose).unwrap().coloured > 5000);
        for (_, colour) in seen(&painter) {
            assert!((colour[0] - colour[1]).abs() <= 1.0 && (colour[0] - colour[2]).abs() <= 1.0, "{colour:?}");
        }
    }
}

#[test]
fn a_colour_is_the_same_in_every_layout() {
    let pose = look_at(EYE, [0.0; 3]);
    let pixels = 640 * 512;
    // A dull orange, (190, 110, 60), by the formulas of BT.601 with a calculator.
    let colours = [
        (PixelFormat::Rgb8, [190, 110, 60].repeat(pixels), 1920),
        (PixelFormat::Yuyv, [126, 94, 126, 167].repeat(pixels / 2), 1280),
        (PixelFormat::YuyvFull, [128, 90, 128, 172].repeat(pixels / 2), 1280),
    ]
    .map(|(format, bytes, stride)| {
        let mut painter = painter(&large_plate());
        painter.frame(&wire::Frame { format, stride, ..frame_of(&CAMERA, bytes, 0) }, &pose).unwrap();
        seen(&painter)
    });
    let [wanted, ..] = &colours;
    assert!(wanted.len() > 500 && wanted.iter().all(|(_, colour)| colour[0] > 1.4 * colour[1]));
    for other in &colours {
        assert_eq!(other.len(), wanted.len());
        for ((_, a), (_, b)) in other.iter().zip(wanted) {
            assert!((0..3).all(|channel| (a[channel] - b[channel]).abs() <= 4.0), "{a:?} {b:?}");
        }
    }
}

#[test]
fn a_cap_hides_nothing_and_is_coloured_by_no_picture() {
    // A white plate, and before it what nobody measured: nothing need be there.
    let world = World::of(vec![(PLATE, white)]);
    let plate = plate_mesh([-0.1, -0.1], [0.1, 0.1], 0.0, 40);
    let cap = plate_mesh([-0.02, -0.02], [0.02, 0.02], 0.05, 8);
    let capped = Mesh { measured: plate.measured, ..join(&plate, &cap) };
    let pose = look_at(EYE, [0.0; 3]);
    let frame = world.frame(&CAMERA, &pose, 0);
    let (mut without, mut with) = (painter(&plate), painter(&capped));
    let coloured = without.frame(&frame, &pose).unwrap().coloured;
    let report = with.frame(&frame, &pose).unwrap();
    assert_eq!(report.coloured, coloured);
    assert!(count(&report.refused, "on a cap") > 1000);
    assert!(seen(&with).iter().all(|(p, _)| p.z < 1e-3));
    assert_eq!(with.model().0.mesh.measured, plate.measured);
    assert_eq!(count(&with.model().1.refused, "on a cap"), count(&report.refused, "on a cap"));
}
