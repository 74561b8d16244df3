//! The lamp, the room, the vignette and the gain.

use crate::bench::*;

#[test]
fn the_lamp_falls_off_with_square_and_cosine() {
    let rig = rig(&format!("{CLEAN}\nvignetting = 0\nlamp = {{ position_mm = [0, 0, 0], level = 0.8 }}"));
    let centre = |surface| mean(&picture(&scene(vec![surface], 0.0), &rig, LAMP), 161, 118, 1) / 255.0;
    let near = centre(square_on(0.2));
    assert!((near - 0.8).abs() < 0.005, "{near}");
    assert!((centre(square_on(0.4)) - 0.2).abs() < 0.004);
    let slanted = centre(plate([0.0, 0.0, 0.2], [1.0, 0.0, -1.0], 0.3));
    assert!((slanted - 0.8 * 0.5f64.sqrt()).abs() < 0.01, "{slanted}");
}

#[test]
fn corners_are_as_dark_as_cosine_to_the_fourth_says() {
    let rig = rig(CLEAN);
    let frame = picture(&scene(vec![square_on(0.2)], 1.0), &rig, ROOM);
    let light = |u: usize, v: usize| {
        mean(&frame, u, v, 1)
            * (1.0 + ((u as f64 - 161.2) / 500.0).powi(2) + ((v as f64 - 118.4) / 499.0).powi(2)).powi(2)
    };
    for (u, v) in [(11, 11), (308, 11), (11, 228), (308, 228), (161, 20)] {
        assert!((light(u, v) / light(161, 118) - 1.0).abs() < 0.01, "at {u} {v}");
    }
    assert!(mean(&frame, 11, 11, 1) < 0.85 * mean(&frame, 161, 118, 1));
}

#[test]
fn the_gain_brings_bright_and_dark_to_the_same_light() {
    let rig = rig(&format!("{CLEAN}\nvignetting = 0").replace("automatic = false", "automatic = true, target = 0.6"));
    let shown = |light: f32| {
        let frame = picture(&scene(vec![square_on(0.2)], light), &rig, ROOM);
        (f64::from(frame.gain), mean(&frame, 161, 118, 1) / 255.0)
    };
    let (full, half) = (shown(0.8), shown(0.4));
    assert!((half.0 / full.0 - 2.0).abs() < 1e-3, "{} {}", half.0, full.0);
    assert!((full.1 - 0.6).abs() < 0.005 && (half.1 - 0.6).abs() < 0.005);
    assert_eq!(shown(0.001).0, 8.0, "no more than the highest");
    // The line is metered on itself.
    let frame = picture(&scene(vec![square_on(0.2)], 0.0), &rig, LASER);
    let mut ridge: Vec<f64> =
        (20..220).map(|row| (0..320).map(|column| value(&frame, column, row, 0)).fold(0.0, f64::max)).collect();
    ridge.sort_by(f64::total_cmp);
    assert!((100.0..=170.0).contains(&ridge[180]), "ridge at {}", ridge[180]);
}

#[test]
fn gamma_bends_the_response() {
    let bent = CLEAN.replace("gamma = 1", "gamma = 2.2");
    let at = |optics: &str| mean(&picture(&scene(vec![square_on(0.2)], 0.4), &rig(optics), ROOM), 161, 118, 1) / 255.0;
    let (straight, bent) = (at(CLEAN), at(&bent));
    assert!((bent.powf(2.2) / straight - 1.0).abs() < 0.03, "{straight} {bent}");
}

#[test]
fn a_texture_colours_what_its_coordinates_say() {
    let mut surface = square_on(0.2);
    surface.mesh.colours.clear();
    surface.mesh.uv = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let rgb = (0..64).flat_map(|_| (0..64).map(|column| if column < 32 { [255, 0, 0] } else { [0, 0, 255] })).collect();
    surface.texture = Some(world::Texture { width: 64, height: 64, rgb });
    let corners = surface.mesh.vertices.clone();
    let frame = picture(&scene(vec![surface], 1.0), &rig(CLEAN), ROOM);
    let camera = rig(CLEAN).camera;
    for (share, red) in [(0.4, true), (0.6, false)] {
        let p = corners[0] + (corners[1] - corners[0]) * share + (corners[3] - corners[0]) * 0.5;
        let pixel = camera.project(&p.cast()).unwrap();
        let [u, v] = [pixel.x.round() as usize, pixel.y.round() as usize];
        let (bright, dark) =
            (value(&frame, u, v, if red { 0 } else { 2 }), value(&frame, u, v, if red { 2 } else { 0 }));
        assert!(bright > 40.0 && dark < 2.0, "at {share}: {bright} {dark}");
    }
}
