//! Surfaces as others write them.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use formats::mesh::{self, LoadedMesh};
use formats::{FormatError, Reason};
use std::path::PathBuf;
use tempfile::TempDir;

fn read(name: &str, bytes: &[u8]) -> (TempDir, Result<LoadedMesh, FormatError>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let read = mesh::read(&path);
    (folder, read)
}

fn good(name: &str, text: &str) -> LoadedMesh {
    read(name, text.as_bytes()).1.unwrap()
}

fn complaint(name: &str, bytes: &[u8]) -> String {
    read(name, bytes).1.unwrap_err().to_string()
}

const SQUARE_PLY: &str = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\n\
    property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
    property list uchar int vertex_indices\nend_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n1 1 0 0 0 255\n0 1 0 9 9 9\n4 0 1 2 3\n";

const TETRA_STL: &str = "solid t\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid t\n";

#[test]
fn ascii_ply_with_colours_and_a_polygon() {
    let mesh = good("square.ply", SQUARE_PLY).mesh;
    assert_eq!(mesh.vertices.len(), 4);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.colours[1], [0, 255, 0]);
    assert_eq!(mesh.area(), 1.0);
}

#[test]
fn binary_ply_of_both_byte_orders() {
    for (name, little) in [("binary_little_endian", true), ("binary_big_endian", false)] {
        let mut bytes = format!(
            "ply\nformat {name} 1.0\nelement vertex 3\nproperty double x\nproperty float y\nproperty short z\n\
             element face 1\nproperty list uchar ushort vertex_index\nend_header\n"
        )
        .into_bytes();
        for [x, y, z] in [[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 0.5, 2.0_f64]] {
            let (y, z) = (y as f32, z as i16);
            bytes.extend(if little { x.to_le_bytes() } else { x.to_be_bytes() });
            bytes.extend(if little { y.to_le_bytes() } else { y.to_be_bytes() });
            bytes.extend(if little { z.to_le_bytes() } else { z.to_be_bytes() });
        }
        bytes.push(3);
        for i in [0, 1, 2_u16] {
            bytes.extend(if little { i.to_le_bytes() } else { i.to_be_bytes() });
        }
        let mesh = read("t.ply", &bytes).1.unwrap().mesh;
        assert_eq!(mesh.area(), 0.25, "{name}");
        assert_eq!(mesh.vertices[2].z, 2.0, "{name}");
    }
}

#[test]
fn text_stl_is_welded() {
    let mesh = good("t.stl", TETRA_STL).mesh;
    assert_eq!(mesh.vertices.len(), 4);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn obj_with_material_colours() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.mtl"), "newmtl red\nKd 1 0 0\nnewmtl grey\nKd 0.5 0.5 0.5\n").unwrap();
    let path = folder.path().join("m.obj");
    let text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\nusemtl grey\nf 1 3 4\n";
    std::fs::write(&path, text).unwrap();
    let LoadedMesh { mesh, texture } = mesh::read(&path).unwrap();
    assert!(texture.is_none());
    assert_eq!(mesh.triangles.len(), 2);
    let colour = |t: usize| mesh.colours[mesh.triangles[t][0] as usize];
    assert_eq!([colour(0), colour(1)], [[255, 0, 0], [128, 128, 128]]);
}

#[test]
fn errors_name_file_and_reason() {
    let missing = mesh::read(&PathBuf::from("/nowhere/cow.obj")).unwrap_err();
    assert!(missing.to_string().starts_with("/nowhere/cow.obj: No such file"), "{missing}");
    let (_folder, unknown) = read("cow.fbx", b"");
    assert!(
        unknown.unwrap_err().to_string().ends_with("\"fbx\" is not understood; known are obj, ply, stl, glb, gltf")
    );
    for (name, bytes, wanted) in [
        ("a.obj", &b"v 0 0 0\n"[..], "a mesh without faces"),
        ("a.obj", b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 0 is not finite"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 3\n", "no valid OBJ"),
        ("a.obj", b"mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "names \"no.mtl\"; looked for /"),
        ("a.ply", &SQUARE_PLY.as_bytes()[..SQUARE_PLY.len() - 4], "truncated inside face 0 of 1 (vertex_indices)"),
        ("a.ply", b"plx\n", "does not begin with the line \"ply\""),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex many\n", "line 3: \"many\" is no count of vertex"),
        ("a.ply", SQUARE_PLY.replace("4 0 1 2 3", "4 0 1 2 4").as_bytes(), "face 0 names vertex 4, but there are 4"),
        ("a.ply", SQUARE_PLY.replace("1 1 0 0 0", "1 nan 0 0 0").as_bytes(), "vertex 2 is not finite"),
        ("a.stl", b"solid t\nfacet\n", "truncated inside the solid"),
        ("a.stl", TETRA_STL.replace("vertex 0 0 1", "vertex 0 0 one").as_bytes(), "line 13: \"one\" is no number"),
        ("a.stl", &[0; 90], "a mesh without faces"),
        ("a.glb", b"glTF\x02\0\0\0\xff\0\0\0\x02\0\0\0JSON{", "truncated inside the JSON chunk"),
        ("a.gltf", b"{}", "no valid glTF"),
    ] {
        let complaint = complaint(name, bytes);
        assert!(complaint.contains(wanted), "{name}: {complaint:?} does not say {wanted:?}");
    }
}

#[test]
fn a_missing_picture_tells_where_it_was_looked_for() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.mtl"), "newmtl skin\nmap_Kd skins\\cow.png\n").unwrap();
    let path = folder.path().join("m.obj");
    let text = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl skin\nf 1/1 2/1 3/1\n";
    std::fs::write(&path, text).unwrap();
    let error = mesh::read(&path).unwrap_err();
    assert!(matches!(error.reason, Reason::Companion { .. }));
    let looked_for = folder.path().join("skins/cow.png");
    assert!(error.to_string().contains(&format!("looked for {}", looked_for.display())), "{error}");
}
