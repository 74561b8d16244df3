//! What we write, read by ourselves and by independent readers.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use formats::mesh::{self, LoadedMesh};
use geometry::TriangleMesh;
use image::{Rgb, RgbImage};
use nalgebra::{Point3, Vector3};
use proptest::prelude::*;
use std::path::PathBuf;
use tempfile::TempDir;

fn place(name: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    (folder, path)
}

/// A bent strip with all attributes.
fn strip() -> TriangleMesh {
    let vertices: Vec<_> =
        (0..10_u8).map(|i| Point3::new(f32::from(i / 2), f32::from(i % 2), f32::from(i).sin())).collect();
    TriangleMesh {
        normals: vec![Vector3::z(); vertices.len()],
        colours: (0..10).map(|i| [i * 28, 255 - i, i]).collect(),
        uv: (0..10_u8).map(|i| [f32::from(i / 2) / 4.0, f32::from(i % 2)]).collect(),
        triangles: (0..8).map(|i| if i % 2 == 0 { [i, i + 2, i + 1] } else { [i, i + 1, i + 2] }).collect(),
        vertices,
    }
}

fn picture() -> RgbImage {
    RgbImage::from_fn(5, 3, |x, y| Rgb([x as u8 * 50, y as u8 * 100, 7]))
}

prop_compose! {
    fn any_mesh()(vertices in prop::collection::vec(prop::array::uniform3(-1e3_f32..1e3), 3..40))(
        triangles in prop::collection::vec(prop::array::uniform3(0..vertices.len() as u32), 1..60),
        colours in prop::collection::vec(prop::array::uniform3(any::<u8>()), vertices.len()),
        vertices in Just(vertices),
    ) -> TriangleMesh {
        let vertices = vertices.into_iter().map(Point3::from).collect();
        TriangleMesh { vertices, colours, triangles, ..TriangleMesh::default() }
    }
}

/// The corners of all triangles: formats may number vertices anew.
fn soup(mesh: &TriangleMesh) -> Vec<[Point3<f32>; 3]> {
    (0..mesh.triangles.len()).map(|t| mesh.corners(t)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_format_gives_back_what_was_written(mesh in any_mesh()) {
        let (folder, ply) = place("m.ply");
        mesh::write_ply(&ply, &mesh).unwrap();
        prop_assert_eq!(&mesh::read(&ply).unwrap().mesh, &mesh);
        let stl = folder.path().join("m.stl");
        mesh::write_stl(&stl, &mesh).unwrap();
        prop_assert_eq!(soup(&mesh::read(&stl).unwrap().mesh), soup(&mesh));
        let glb = folder.path().join("m.glb");
        mesh::write_glb(&glb, &mesh, None).unwrap();
        prop_assert_eq!(&mesh::read_z_up(&glb).unwrap().mesh, &mesh);
        let obj = folder.path().join("m.obj");
        mesh::write_obj(&obj, &mesh, None).unwrap();
        let read = mesh::read(&obj).unwrap().mesh;
        let colours = |mesh: &TriangleMesh| -> Vec<[u8; 3]> {
            mesh.triangles.iter().flatten().map(|&i| mesh.colours[i as usize]).collect()
        };
        prop_assert_eq!(soup(&read), soup(&mesh));
        prop_assert_eq!(colours(&read), colours(&mesh));
    }
}

#[test]
fn obj_and_glb_keep_the_texture() {
    let mesh = strip();
    for name in ["model.obj", "model.glb"] {
        let (_folder, path) = place(name);
        let texture = picture();
        let write = if name.ends_with("obj") { mesh::write_obj } else { mesh::write_glb };
        write(&path, &mesh, Some(&texture)).unwrap();
        let LoadedMesh { mesh: read, texture: read_texture } = mesh::read_z_up(&path).unwrap();
        assert_eq!(read_texture.as_ref(), Some(&texture), "{name}");
        assert_eq!(soup(&read), soup(&mesh), "{name}");
        let corners =
            |mesh: &TriangleMesh| mesh.triangles.concat().iter().map(|&i| mesh.uv[i as usize]).collect::<Vec<_>>();
        for (a, b) in corners(&read).iter().zip(corners(&mesh)) {
            assert!((a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-6, "{name}: {a:?} {b:?}");
        }
    }
}

#[test]
fn an_independent_reader_accepts_the_glb() {
    let (_folder, path) = place("model.glb");
    let mesh = strip();
    mesh::write_glb(&path, &mesh, Some(&picture())).unwrap();
    // The crate validates the whole document as it imports.
    let (document, buffers, images) = gltf::import(&path).unwrap();
    let primitive = document.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|buffer| Some(&buffers[buffer.index()]));
    let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
    let expected: Vec<[f32; 3]> = mesh.vertices.iter().map(|p| [p.x, p.z, -p.y]).collect();
    assert_eq!(positions, expected, "z up becomes y up");
    assert!(reader.read_normals().unwrap().all(|n| n == [0.0, 1.0, 0.0]));
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    assert_eq!(indices, mesh.triangles.concat());
    let uv: Vec<[f32; 2]> = reader.read_tex_coords(0).unwrap().into_f32().collect();
    assert_eq!(uv, mesh.uv);
    assert_eq!(images[0].pixels, picture().into_raw());
    let bounds = primitive.bounding_box();
    for axis in 0..3 {
        let along = expected.iter().map(|p| p[axis]);
        assert_eq!(bounds.min[axis], along.clone().fold(f32::INFINITY, f32::min));
        assert_eq!(bounds.max[axis], along.fold(f32::NEG_INFINITY, f32::max));
    }
}

#[test]
fn the_glb_is_laid_out_as_the_specification_asks() {
    let (_folder, path) = place("model.glb");
    mesh::write_glb(&path, &strip(), Some(&picture())).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(&bytes[..4], b"glTF");
    assert_eq!((word(4), word(8)), (2, bytes.len()));
    let json_length = word(12);
    assert_eq!((&bytes[16..20], json_length % 4), (&b"JSON"[..], 0));
    let root: serde_json::Value = serde_json::from_slice(&bytes[20..20 + json_length]).unwrap();
    let binary = 20 + json_length;
    assert_eq!((&bytes[binary + 4..binary + 8], word(binary) % 4), (&b"BIN\0"[..], 0));
    assert_eq!(word(binary) as u64, root["buffers"][0]["byteLength"].as_u64().unwrap());
    assert_eq!(binary + 8 + word(binary), bytes.len());
    for view in root["bufferViews"].as_array().unwrap() {
        assert_eq!(view["byteOffset"].as_u64().unwrap() % 4, 0);
    }
    let png = root["bufferViews"][root["images"][0]["bufferView"].as_u64().unwrap() as usize]["byteOffset"].as_u64();
    assert_eq!(&bytes[binary + 8 + png.unwrap() as usize..][..4], b"\x89PNG");
}

#[test]
fn a_failed_write_leaves_the_old_file_and_no_half_one() {
    let (folder, path) = place("m.ply");
    mesh::write_ply(&path, &strip()).unwrap();
    let before = std::fs::read(&path).unwrap();
    assert!(
        mesh::write_ply(&path, &TriangleMesh::default())
            .unwrap_err()
            .to_string()
            .ends_with("without faces (0 vertices)")
    );
    let interrupted = formats::write_whole(&path, |_| Err(formats::Reason::Empty("the disk is full")));
    assert!(interrupted.is_err());
    assert_eq!(std::fs::read(&path).unwrap(), before);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn parts_with_different_pictures_and_colours_become_one() {
    let (folder, path) = place("parts.obj");
    for (name, colour) in [("red", [255, 0, 0]), ("green", [0, 255, 0])] {
        RgbImage::from_pixel(8, 8, Rgb(colour)).save(folder.path().join(format!("{name}.png"))).unwrap();
    }
    let materials = "newmtl a\nmap_Kd red.png\nnewmtl b\nmap_Kd green.png\nnewmtl c\nKd 0 0 1\n";
    std::fs::write(folder.path().join("parts.mtl"), materials).unwrap();
    let text = "mtllib parts.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 3.1 -2.9\nvt 3.9 -2.9\nvt 3.1 -2.1\n\
        usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 2/2 3/3\nusemtl c\nf 1 2 3\n";
    std::fs::write(&path, text).unwrap();
    let LoadedMesh { mesh, texture } = mesh::read(&path).unwrap();
    let texture = texture.unwrap();
    let colour = |t: usize| {
        let corners = mesh.triangles[t].map(|i| mesh.uv[i as usize]);
        let centre = [0, 1].map(|axis| corners.iter().map(|c| c[axis]).sum::<f32>() / 3.0);
        let pixel = |at: f32, size: u32| (at * size as f32) as u32;
        texture.get_pixel(pixel(centre[0], texture.width()), pixel(centre[1], texture.height())).0
    };
    assert_eq!([colour(0), colour(1), colour(2)], [[255, 0, 0], [0, 255, 0], [0, 0, 255]]);
}

#[test]
fn the_sigma_of_each_vertex_stands_in_the_ply_and_half_of_them_do_not() {
    let (folder, path) = place("measured.ply");
    let mesh = strip();
    let sigma_m: Vec<f32> = (0..mesh.vertices.len()).map(|i| i as f32 * 1e-5).collect();
    mesh::write_measured_ply(&path, &mesh, &sigma_m).unwrap();
    assert_eq!(soup(&mesh::read(&path).unwrap().mesh), soup(&mesh));
    // A vertex is a point with a sigma to whoever reads points.
    let points = formats::cloud::read(&path).unwrap();
    assert_eq!(points.iter().map(|point| point.sigma_m).collect::<Vec<_>>(), sigma_m);
    let bare = folder.path().join("bare.ply");
    mesh::write_measured_ply(&bare, &mesh, &sigma_m[1..]).unwrap();
    assert!(formats::cloud::read(&bare).unwrap().iter().all(|point| point.sigma_m == 0.0));
}
