//! What no camera can show is refused, with its name.

use crate::bench::*;
use nalgebra::{Isometry3, Translation3};
use world::optics::{CameraModelSim, OpticsError, Workspace};

#[test]
fn numbers_out_of_range_are_named() {
    let plates = scene(vec![square_on(0.2)], 0.1);
    for (optics, key) in [
        ("rate_hz = 0", "rate_hz"),
        ("psf_sigma_px = nan", "psf_sigma_px"),
        ("laser = { speckle_contrast = -1 }", "laser.speckle_contrast"),
        ("sensor = { gamma = 0 }", "sensor.gamma"),
        ("gain = { lowest = 4, highest = 2 }", "gain.highest"),
        ("lamp_every = 1", "lamp_every"),
        ("bright = 1", "bright"),
        ("sensor = { colour = 1 }", "colour"),
    ] {
        let error = CameraModelSim::new(&plates, &rig(optics), 1).err().unwrap_or_else(|| panic!("{optics} was taken"));
        assert!(error.to_string().contains(key), "{optics}: {error}");
    }
    let beside = rig("laser = { source_mm = [0, 0, 200] }");
    assert!(matches!(CameraModelSim::new(&plates, &beside, 1), Err(OpticsError::Fan { .. })));
}

#[test]
fn meshes_that_cannot_be_seen_are_named() {
    let mut empty = square_on(0.2);
    empty.mesh.triangles.clear();
    let mut torn = square_on(0.2);
    torn.texture = Some(world::Texture { width: 4, height: 4, rgb: vec![[0; 3]; 15] });
    let mut wild = square_on(0.2);
    wild.mesh.vertices[2].x = f32::NAN;
    for surface in [empty, torn, wild] {
        let error = CameraModelSim::new(&scene(vec![surface], 0.1), &rig(""), 1).err().unwrap();
        assert!(error.to_string().starts_with("plate: "), "{error}");
    }
}

#[test]
fn a_camera_that_sees_nothing_still_makes_pictures() {
    for (surfaces, camera) in [
        (vec![], Isometry3::identity()),
        (
            vec![square_on(0.2)],
            Isometry3::from_parts(Translation3::new(0.0, 0.0, 0.5), nalgebra::UnitQuaternion::identity()),
        ),
        (vec![square_on(0.2)], Isometry3::translation(0.0, 0.0, 0.2)),
    ] {
        let model = CameraModelSim::new(&scene(surfaces, 0.1), &rig(""), 1).unwrap();
        for light in [LASER, LAMP, ROOM] {
            model.render(0, &camera, light, &mut Workspace::default()).check().unwrap();
        }
    }
}
