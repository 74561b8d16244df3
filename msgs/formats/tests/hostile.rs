//! Bytes from anywhere: every parser answers, none panics, none allocates what is not there.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use formats::{cloud, image_file, mesh};
use geometry::TriangleMesh;
use image::{Rgb, RgbImage};
use nalgebra::Point3;
use proptest::prelude::*;
use std::path::Path;

fn read_all(folder: &Path, ending: &str, bytes: &[u8]) {
    let path = folder.join(format!("hostile.{ending}"));
    std::fs::write(&path, bytes).unwrap();
    match ending {
        "xyz" | "csv" => drop(cloud::read(&path)),
        "png" | "jpg" => drop(image_file::read_frame(&path)),
        _ => drop(mesh::read_z_up(&path)),
    }
    if ending == "ply" {
        drop(cloud::read(&path));
    }
}

/// A good file of each format.
fn good(folder: &Path, ending: &str) -> Vec<u8> {
    let path = folder.join(format!("good.{ending}"));
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point3::from).to_vec();
    let uv = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    let mesh = TriangleMesh { vertices, uv, triangles, colours: vec![[9, 8, 7]; 4], ..TriangleMesh::default() };
    let picture = RgbImage::from_fn(4, 4, |x, y| Rgb([x as u8, y as u8, 3]));
    match ending {
        "ply" => mesh::write_ply(&path, &mesh).unwrap(),
        "stl" => mesh::write_stl(&path, &mesh).unwrap(),
        "obj" => mesh::write_obj(&path, &mesh, Some(&picture)).unwrap(),
        "glb" => mesh::write_glb(&path, &mesh, Some(&picture)).unwrap(),
        "png" => image_file::write_rgb(&path, &picture).unwrap(),
        "jpg" => picture.save(&path).unwrap(),
        _ => std::fs::write(&path, "x,y,z\n1,2,3\n4,5,6\n").unwrap(),
    }
    std::fs::read(&path).unwrap()
}

const ENDINGS: [&str; 9] = ["ply", "stl", "obj", "glb", "gltf", "png", "jpg", "xyz", "csv"];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn garbage(ending in prop::sample::select(&ENDINGS[..]), bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let folder = tempfile::tempdir().unwrap();
        read_all(folder.path(), ending, &bytes);
    }

    #[test]
    fn cut_and_flipped(
        ending in prop::sample::select(&ENDINGS[..]),
        cut in any::<prop::sample::Index>(),
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let mut bytes = good(folder.path(), ending);
        for (at, value) in flips {
            let at = at.index(bytes.len());
            bytes[at] ^= value;
        }
        read_all(folder.path(), ending, &bytes);
        bytes.truncate(cut.index(bytes.len()));
        read_all(folder.path(), ending, &bytes);
    }

    #[test]
    fn words_of_an_obj_in_any_order(words in prop::collection::vec(prop::sample::select(&[
        "v", "vt", "vn", "f", "\n", "\n", "\n", "0", "1", "2", "-1", "-9", "1/1", "1//1", "1/1/1", "99999999999", "1e400", "nan",
        "usemtl", "mtllib", "o", "g", "é", "\\", "/", "l", "p", "s",
    ][..]), 0..80)) {
        let folder = tempfile::tempdir().unwrap();
        read_all(folder.path(), "obj", words.join(" ").as_bytes());
    }

    #[test]
    fn numbers_of_a_gltf(which in any::<prop::sample::Index>(), value in prop::sample::select(&[
        "-1", "0", "1", "3", "5", "4294967295", "18446744073709551615", "1e300", "null", "\"x\"", "5120", "5121", "5123", "5126",
    ][..])) {
        let folder = tempfile::tempdir().unwrap();
        let text = include_str!("triangle.gltf");
        let numbers: Vec<(usize, &str)> = text.match_indices(": ").filter_map(|(at, _)| {
            let rest = &text[at + 2..];
            let length = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(0);
            (length > 0).then(|| (at + 2, &rest[..length]))
        }).collect();
        let (at, number) = numbers[which.index(numbers.len())];
        let changed = format!("{}{value}{}", &text[..at], &text[at + number.len()..]);
        read_all(folder.path(), "gltf", changed.as_bytes());
    }
}

#[test]
fn a_header_that_promises_too_much_allocates_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let ply = b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000000000\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n\0\0\0\0";
    read_all(folder.path(), "ply", ply);
    let mut stl = vec![0; 84];
    stl[80..].copy_from_slice(&u32::MAX.to_le_bytes());
    read_all(folder.path(), "stl", &stl);
}

#[test]
fn the_plain_gltf_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.gltf");
    std::fs::write(&path, include_str!("triangle.gltf")).unwrap();
    let mesh = mesh::read(&path).unwrap().mesh;
    assert_eq!(mesh.vertices[1], Point3::new(12.0, 0.0, 0.0), "scaled by 2, moved by 10");
    assert_eq!(mesh.colours[0], [255, 188, 0], "half the light is 188 of 255");
}
