//! Borders between colours, where it is known how far they are off.

use formats::mesh::LoadedMesh;
use geometry::TriangleMesh;
use image::RgbImage;
use nalgebra::Point3;
use report::{BorderError, ColourErrorReason, border_error};
use wire::{Header, Mesh, Model};

/// Of a square's side, and the cells of the model on it: 0.25 mm each.
const SIDE_M: f32 = 0.04;
const CELLS: u32 = 160;
const DARK: [u8; 3] = [62, 58, 56];
const BRIGHT: [u8; 3] = [233, 228, 216];

fn square() -> TriangleMesh {
    let corners = [[0.0, 0.0], [SIDE_M, 0.0], [SIDE_M, SIDE_M], [0.0, SIDE_M]];
    TriangleMesh {
        vertices: corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec(),
        uv: corners.map(|[x, y]| [x / SIDE_M, y / SIDE_M]).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    }
}

fn linear(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

fn byte(linear: f64) -> u8 {
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

/// A share of the bright colour in the dark one's place.
fn mixed(bright: f64) -> [u8; 3] {
    [0, 1, 2].map(|c| byte(linear(DARK[c]) + bright.clamp(0.0, 1.0) * (linear(BRIGHT[c]) - linear(DARK[c]))))
}

/// A disc of radius 10 mm in the middle: how far a point of the square is outside it, in mm.
fn outside_mm(x_mm: f64, y_mm: f64) -> f64 {
    (x_mm - 20.0).hypot(y_mm - 20.0) - 10.0
}

/// A bright disc on dark ground as a texture: pixels of 0.05 mm.
fn truth() -> LoadedMesh {
    let pixel = |u, v| {
        let [x, y] = [u, v].map(|c| (f64::from(c) + 0.5) * 0.05);
        image::Rgb(if outside_mm(x, y) < 0.0 { BRIGHT } else { DARK })
    };
    LoadedMesh { mesh: square(), texture: Some(RgbImage::from_fn(800, 800, pixel)) }
}

/// The square, painted with a colour for each place in mm.
fn model(colour: impl Fn(f64, f64) -> [u8; 4]) -> Model {
    let square = square();
    let place = |i: u32| (f64::from(i) + 0.5) * 40.0 / f64::from(CELLS);
    Model {
        header: Header::default(),
        mesh: Mesh {
            header: Header::default(),
            vertices_m: square.vertices.iter().map(|p| (*p).into()).collect(),
            normals: vec![].into(),
            sigma_m: vec![].into(),
            measured: square.triangles.len() as u32,
            triangles: square.triangles.into(),
        },
        uv: square.uv.into(),
        texture_width: CELLS,
        texture_height: CELLS,
        texture: (0..CELLS * CELLS).map(|i| colour(place(i % CELLS), place(i / CELLS))).collect(),
        cell_m: 0.25e-3,
    }
}

/// The disc, so much larger, its border blurred over `width_mm`.
fn disc(larger_mm: f64, width_mm: f64) -> impl Fn(f64, f64) -> [u8; 4] {
    move |x, y| {
        let [r, g, b] = mixed(0.5 + (larger_mm - outside_mm(x, y)) / width_mm);
        [r, g, b, 255]
    }
}

fn judged(model: &Model) -> BorderError {
    border_error(model, &truth()).expect("they can be compared").expect("there is a border")
}

#[test]
fn a_border_in_its_place_is_found_there_however_blurred() {
    for width_mm in [0.3, 1.0, 1.8] {
        let error = judged(&model(disc(0.0, width_mm)));
        assert!(error.places > 500 && error.lost + error.unseen == 0, "{error:?}");
        assert!(error.rms_mm < 0.04, "{width_mm} mm wide: {error:?}");
    }
}

#[test]
fn a_border_that_lies_elsewhere_is_that_far_off() {
    for larger_mm in [0.2, 0.5, -0.8] {
        let error = judged(&model(disc(larger_mm, 0.5)));
        for measured in [error.rms_mm, error.median_mm, error.p95_mm] {
            assert!((measured - f64::abs(larger_mm)).abs() < 0.04, "{larger_mm}: {error:?}");
        }
    }
}

#[test]
fn a_shift_along_the_surface_counts_as_far_as_it_is_across_the_border() {
    // 0.6 mm to the right: around the disc the share across it is the cosine.
    let moved = disc(0.0, 0.5);
    let error = judged(&model(|x, y| moved(x - 0.6, y)));
    assert!((error.rms_mm - 0.6 / 2f64.sqrt()).abs() < 0.03, "{error:?}");
    assert!((error.p95_mm - 0.6).abs() < 0.04, "{error:?}");
}

#[test]
fn a_gain_on_the_light_moves_no_border() {
    let darker = |c: u8, gain: f64| byte(linear(c) / gain);
    let plain = disc(0.3, 0.8);
    let error = judged(&model(|x, y| {
        let [r, g, b, how] = plain(x, y);
        [darker(r, 1.5), darker(g, 1.2), darker(b, 1.9), how]
    }));
    assert!((error.rms_mm - 0.3).abs() < 0.04, "{error:?}");
}

#[test]
fn what_was_not_seen_and_what_has_no_border_is_counted_apart() {
    let half = disc(0.0, 0.5);
    let error = judged(&model(|x, y| if x < 20.0 { half(x, y) } else { [90, 90, 90, 85] }));
    assert!(error.unseen > error.places / 2 && error.rms_mm < 0.05 && error.lost == 0, "{error:?}");

    let grey = judged(&model(|_, _| [150, 150, 150, 255]));
    assert!(grey.places == 0 && grey.lost > 500 && grey.rms_mm == 0.0, "{grey:?}");
    let swapped = judged(&model(|x, y| {
        let [r, g, b] = mixed(outside_mm(x, y));
        [r, g, b, 255]
    }));
    assert!(swapped.places == 0 && swapped.lost > 500, "bright and dark the wrong way round: {swapped:?}");
}

#[test]
fn a_truth_of_vertex_colours_has_borders_where_triangles_of_two_colours_meet() {
    // A dark and a bright half that meet at x = 20 mm, along triangles' edges.
    let place = |x, y| Point3::new(x, y, 0.0);
    let middle = SIDE_M / 2.0;
    let (left, right) = ([0.0, middle], [middle, SIDE_M]);
    let vertices =
        [left, right].map(|[from, to]| [place(from, 0.0), place(to, 0.0), place(to, SIDE_M), place(from, SIDE_M)]);
    let halves = TriangleMesh {
        vertices: vertices.concat(),
        colours: [[DARK; 4], [BRIGHT; 4]].concat(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
        ..TriangleMesh::default()
    };
    let truth = LoadedMesh { mesh: halves, texture: None };
    let ramp = model(|x, _| {
        let [r, g, b] = mixed(0.5 + (x - 20.4) / 0.5);
        [r, g, b, 255]
    });
    let error = border_error(&ramp, &truth).expect("they can be compared").expect("there is a border");
    assert!((error.rms_mm - 0.4).abs() < 0.04 && (error.median_mm - 0.4).abs() < 0.04, "{error:?}");
}

#[test]
fn a_truth_of_one_colour_has_no_border_and_a_broken_model_is_named() {
    let plain = LoadedMesh { mesh: square(), texture: Some(RgbImage::from_pixel(8, 8, image::Rgb(BRIGHT))) };
    assert_eq!(border_error(&model(disc(0.0, 0.5)), &plain), Ok(None));
    let uncoloured = LoadedMesh { mesh: square(), texture: None };
    assert_eq!(border_error(&model(disc(0.0, 0.5)), &uncoloured), Ok(None));
    let mut short = model(disc(0.0, 0.5));
    short.texture.pop();
    assert!(matches!(border_error(&short, &truth()), Err(ColourErrorReason::Texture { .. })));
    let mut faceless = model(disc(0.0, 0.5));
    faceless.mesh.triangles.clear();
    assert!(matches!(border_error(&faceless, &truth()), Err(ColourErrorReason::Model(_))));
    let mut nowhere = model(disc(0.0, 0.5));
    nowhere.uv.iter_mut().for_each(|uv| *uv = [f32::NAN, 1e30]);
    assert!(border_error(&nowhere, &truth()).is_ok_and(|error| error.is_some_and(|error| error.rms_mm.is_finite())));
}
