//! Colours against a known albedo.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod scene;

use nalgebra::Isometry3;
use paint::{Config, Painter};
use scene::*;
use wire::{Mesh, Model};

/// Twelve views from around, at differing distances.
fn views() -> Vec<Isometry3<f64>> {
    (0..12)
        .map(|i| {
            let turn = f64::from(i) * 2.4;
            let (lean, distance) = (0.1 + 0.04 * f64::from(i), 0.17 + 0.006 * f64::from(i));
            let eye = [distance * lean.sin() * turn.cos(), distance * lean.sin() * turn.sin(), distance * lean.cos()];
            look_at(eye, [0.004 * turn.cos(), 0.004 * turn.sin(), 0.0])
        })
        .collect()
}

fn painted(world: &World, mesh: &Mesh, config: Config) -> (Model, paint::Evidence) {
    let mut painter = Painter::new(config, &calibration(&CAMERA)).unwrap();
    painter.mesh(mesh).unwrap();
    for (seq, pose) in views().iter().enumerate() {
        painter.frame(&world.frame(&CAMERA, pose, seq as u64), pose).unwrap();
    }
    painter.model()
}

const PLATE: Shape = Shape::Plate { low: [-0.06; 2], high: [0.06; 2], z: 0.0 };

#[test]
fn a_checked_plate_gets_its_colours_back() {
    let world = World::of(vec![(PLATE, checker)]);
    let (model, _) = painted(&world, &plate_mesh([-0.06; 2], [0.06; 2], 0.0, 60), Config::default());
    let seen: Vec<_> = places(&model).into_iter().filter(|(_, colour)| colour[3] == 255.0).collect();
    let clear: Vec<_> = seen.iter().copied().filter(|(p, _)| from_border(p, &[0, 1]) > 0.002).collect();
    assert!(clear.len() > 1000);
    assert!(rms(&clear, checker) < 2.0, "{}", rms(&clear, checker));
}

#[test]
fn a_sphere_in_ambient_light_with_gleams_gets_its_colours_back() {
    let mut world = World::of(vec![(Shape::Sphere { centre: [0.0, 0.0, -0.03].into(), radius: 0.03 }, checker)]);
    (world.ambient, world.specular) = (0.3, 0.2);
    let (model, evidence) = painted(&world, &sphere_mesh([0.0, 0.0, -0.03], 0.03, 40), Config::default());
    let seen: Vec<_> = places(&model).into_iter().filter(|(_, colour)| colour[3] == 255.0).collect();
    let clear: Vec<_> = seen.iter().copied().filter(|(p, _)| from_border(p, &[0, 1, 2]) > 0.002).collect();
    assert!(clear.len() > 300);
    assert!(rms(&clear, checker) < 5.0, "{}", rms(&clear, checker));
    assert!((evidence.ambient[1] - 0.3).abs() < 0.15, "{:?}", evidence.ambient);
}
