//! Colours against a truth that is known.

use formats::mesh::LoadedMesh;
use geometry::TriangleMesh;
use image::RgbImage;
use nalgebra::Point3;
use report::{ColourErrorReason, colour_error, painted};
use wire::{Header, Mesh, Model};

const SIDE: u32 = 40;

/// A square of 40 mm.
fn square() -> TriangleMesh {
    let corners = [[0.0, 0.0], [0.04, 0.0], [0.04, 0.04], [0.0, 0.04]];
    TriangleMesh {
        vertices: corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec(),
        uv: corners.map(|[x, y]| [x / 0.04, y / 0.04]).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    }
}

fn board(column: u32, row: u32) -> [u8; 3] {
    if (column / 5 + row / 5).is_multiple_of(2) { [200, 60, 30] } else { [90, 160, 220] }
}

/// The square with a cell of 1 mm for each pixel of the board, as `paint` sees it.
fn model(cell: impl Fn(u32, u32) -> [u8; 4]) -> Model {
    let square = square();
    let mesh = Mesh {
        header: Header::default(),
        vertices_m: square.vertices.iter().map(|p| (*p).into()).collect(),
        normals: vec![].into(),
        sigma_m: vec![].into(),
        measured: square.triangles.len() as u32,
        triangles: square.triangles.into(),
    };
    Model {
        header: Header::default(),
        mesh,
        uv: square.uv.into(),
        texture_width: SIDE,
        texture_height: SIDE,
        texture: (0..SIDE * SIDE).map(|i| cell(i % SIDE, i / SIDE)).collect(),
        cell_m: 1e-3,
    }
}

fn truth() -> LoadedMesh {
    // Eight pixels a cell, so that the edges of the board are sharp.
    let texture = RgbImage::from_fn(8 * SIDE, 8 * SIDE, |u, v| image::Rgb(board(u / 8, v / 8)));
    LoadedMesh { mesh: square(), texture: Some(texture) }
}

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 255]
}

#[test]
fn the_same_colours_differ_by_nothing() {
    let error = colour_error(&model(|u, v| opaque(board(u, v))), &truth()).unwrap();
    assert!(error.cells >= (SIDE * SIDE) as usize, "{error:?}");
    assert!(error.rms_255 < 0.6 && error.gain.iter().all(|g| (g - 1.0).abs() < 0.01), "{error:?}");
}

#[test]
fn a_gain_on_the_light_of_a_channel_is_found_and_taken_out() {
    let linear = |byte: u8| (f64::from(byte) / 255.0).powf(2.2);
    let darker = |byte: u8, gain: f64| (255.0 * (linear(byte) / gain).powf(1.0 / 2.2)).round() as u8;
    let gains = [1.5, 1.2, 2.0];
    let cell = |u, v| {
        let [r, g, b] = board(u, v);
        [darker(r, gains[0]), darker(g, gains[1]), darker(b, gains[2]), 255]
    };
    let error = colour_error(&model(cell), &truth()).unwrap();
    assert!(error.gain.iter().zip(gains).all(|(found, true_gain)| (found / true_gain - 1.0).abs() < 0.03), "{error:?}");
    assert!(error.rms_255 < 2.5, "{error:?}");
}

#[test]
fn an_error_of_known_size_is_measured() {
    // Half of the cells 10 too bright, half 10 too dark.
    let cell = |u: u32, v: u32| opaque(board(u, v).map(|c| if (u + v).is_multiple_of(2) { c + 10 } else { c - 10 }));
    let error = colour_error(&model(cell), &truth()).unwrap();
    assert!((error.rms_255 - 10.0).abs() < 0.7, "{error:?}");
}

#[test]
fn only_cells_that_were_seen_count() {
    let cell = |u, v| if u < 10 { opaque(board(u, v)) } else { [255, 0, 255, if u < 20 { 85 } else { 0 }] };
    let error = colour_error(&model(cell), &truth()).unwrap();
    assert!(error.rms_255 < 0.6 && error.cells < 440, "{error:?}");
    let unseen = colour_error(&model(|_, _| [1, 2, 3, 85]), &truth());
    assert_eq!(unseen, Err(ColourErrorReason::NothingSeen));
}

#[test]
fn what_cannot_be_compared_is_named() {
    let good = model(|u, v| opaque(board(u, v)));
    let plain = LoadedMesh { mesh: square(), texture: None };
    assert_eq!(colour_error(&good, &plain), Err(ColourErrorReason::TruthWithoutColours));
    let mut short = good.clone();
    short.texture.pop();
    assert!(matches!(colour_error(&short, &truth()), Err(ColourErrorReason::Texture { cells: 1599, .. })));
    let mut nowhere = good.clone();
    nowhere.uv.0[0] = [f32::NAN, 1e30];
    nowhere.uv.0[2] = [f32::INFINITY, -1e30];
    assert!(colour_error(&nowhere, &truth()).is_err(), "no place in the texture, no cell");
    let mut faceless = good;
    faceless.mesh.triangles.clear();
    assert!(matches!(colour_error(&faceless, &truth()), Err(ColourErrorReason::Model(_))));
}

#[test]
fn a_model_becomes_a_mesh_with_a_picture() {
    let surface = painted(&model(|u, _| if u == 0 { [9, 9, 9, 0] } else { [1, 2, 3, 255] }));
    let texture = surface.texture.unwrap();
    assert_eq!((texture.get_pixel(0, 0).0, texture.get_pixel(1, 0).0), ([128; 3], [1, 2, 3]));
    assert_eq!(surface.mesh.uv.len(), 4);
}
