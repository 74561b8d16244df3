//! From the last message of each stream to files that can be read again.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

use export::{Config, Exporter};
use formats::{cloud, mesh};
use std::fs;
use tempfile::TempDir;
use wire::{Cloud, CloudPoint, Extent, Header, Mesh, Model, Phase};

fn exporter() -> (TempDir, Exporter) {
    let folder = tempfile::tempdir().unwrap();
    let exporter = Exporter::new(Config { folder: folder.path().join("deep/out") }).unwrap();
    (folder, exporter)
}

fn header(phase: Phase, revision: u32) -> Header {
    Header { phase, revision, ..Header::default() }
}

fn ball(id: u32, x: f32) -> CloudPoint {
    CloudPoint { id, position_m: [x, 0.0, 0.0], count: 3, sigma_m: 1e-4, ..CloudPoint::default() }
}

fn changes(phase: Phase, revision: u32, points: Vec<CloudPoint>) -> Cloud {
    Cloud {
        header: header(phase, revision),
        extent: Extent::Changes,
        table: None,
        points: points.into(),
        refused: Vec::new(),
    }
}

fn square(phase: Phase) -> Mesh {
    Mesh {
        header: header(phase, 0),
        vertices_m: vec![[0.0, 0.0, 0.5], [0.1, 0.0, 0.5], [0.1, 0.1, 0.5], [0.0, 0.1, 0.5]].into(),
        normals: vec![[0.0, 0.0, 1.0]; 4].into(),
        sigma_m: vec![].into(),
        triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
        measured: 2,
    }
}

fn painted(phase: Phase) -> Model {
    Model {
        header: header(phase, 0),
        mesh: square(phase),
        uv: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].into(),
        texture_width: 2,
        texture_height: 1,
        texture: vec![[255, 0, 0, 255], [0, 0, 255, 85]].into(),
        cell_m: 1e-3,
    }
}

#[test]
fn a_cloud_is_put_together_from_changes_and_written_at_the_end() {
    let (_folder, mut exporter) = exporter();
    assert!(exporter.cloud(&changes(Phase::Shape, 0, vec![ball(9, 9.0)])).unwrap().is_empty());
    let gone = CloudPoint { count: 0, ..ball(3, 0.3) };
    let whole =
        Cloud { extent: Extent::Whole, ..changes(Phase::Shape, 1, vec![ball(2, 0.2), ball(1, 0.1), ball(3, 0.3)]) };
    assert!(exporter.cloud(&whole).unwrap().is_empty());
    assert!(exporter.cloud(&changes(Phase::Shape, 2, vec![gone])).unwrap().is_empty());
    exporter.cloud(&changes(Phase::Shape, 0, vec![ball(8, 8.0)])).unwrap();
    let written = exporter.cloud(&changes(Phase::End, 2, vec![ball(2, 0.3)])).unwrap();
    assert_eq!(cloud::read(&written[0].path).unwrap(), [ball(1, 0.1), ball(2, 0.3)]);
    assert_eq!(
        (written[0].holds.as_str(), written[0].bytes),
        ("2 points", fs::metadata(&written[0].path).unwrap().len())
    );
}

#[test]
fn only_the_final_surface_is_written() {
    let (folder, exporter) = exporter();
    assert!(exporter.mesh(&square(Phase::Shape)).unwrap().is_empty());
    assert!(exporter.model(&painted(Phase::Both)).unwrap().is_empty());
    assert_eq!(fs::read_dir(folder.path().join("deep/out")).unwrap().count(), 0);
    for written in exporter.mesh(&square(Phase::End)).unwrap() {
        let read = mesh::read(&written.path).unwrap().mesh;
        assert_eq!((read.triangles.len(), read.vertices[0].z), (2, 0.5), "{written}");
    }
}

#[test]
fn what_was_measured_and_what_closes_it_go_to_files_of_their_own() {
    let (_folder, exporter) = exporter();
    let mut capped = square(Phase::End);
    capped.vertices_m.push([0.05, 0.05, 0.4]);
    capped.normals.push([0.0, 0.0, -1.0]);
    capped.sigma_m = vec![1e-5, 1e-5, 1e-5, 1e-5, 0.06].into();
    capped.triangles.extend([[1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]]);
    let written = exporter.mesh(&capped).unwrap();
    let [ply, stl] = [0, 1].map(|k: usize| mesh::read(&written[k].path).unwrap().mesh);
    assert_eq!((ply.vertices.len(), ply.triangles.len(), ply.open_edges()), (4, 2, 4), "{}", written[0]);
    assert_eq!((stl.vertices.len(), stl.triangles.len(), stl.open_edges()), (5, 6, 0), "{}", written[1]);
    let model = exporter.model(&Model { mesh: square(Phase::End), ..painted(Phase::End) }).unwrap();
    assert!(model[0].to_string().contains("2 triangles"));
}

#[test]
fn the_painted_surface_lies_where_it_was_scanned_in_every_format() {
    let (_folder, exporter) = exporter();
    let written = exporter.model(&painted(Phase::End)).unwrap();
    let names: Vec<_> = written.iter().map(|w| w.path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["model.glb", "model.obj", "model.mtl", "model.png"]);
    for file in &written[..2] {
        let read = mesh::read_z_up(&file.path).unwrap();
        assert!(read.mesh.vertices.iter().all(|p| p.z == 0.5), "{file}");
        assert_eq!(read.texture.unwrap().into_raw(), [255, 0, 0, 0, 0, 255], "{file}");
    }
}

#[test]
fn the_cloud_takes_its_colours_from_the_surface_beside_it() {
    let (_folder, mut exporter) = exporter();
    let at = |id: u32, x: f32, z: f32| CloudPoint { position_m: [x, 0.05, z], ..ball(id, x) };
    let own = CloudPoint { colour: [9, 8, 7, 255], ..at(3, 0.02, 0.5) };
    let balls = vec![at(0, 0.02, 0.501), at(1, 0.08, 0.499), at(2, 0.02, 0.6), own];
    exporter.cloud(&changes(Phase::End, 0, balls)).unwrap();
    let written = exporter.model(&painted(Phase::End)).unwrap();
    let path = &written.last().unwrap().path;
    assert!(path.ends_with("cloud.ply"));
    let colours: Vec<_> = cloud::read(path).unwrap().iter().map(|ball| ball.colour).collect();
    // The third is far from the surface; the last had a colour of its own.
    assert_eq!(colours, [[255, 0, 0, 255], [0, 0, 255, 255], [0; 4], [9, 8, 7, 255]]);

    // That of another scan is left alone, and so is a cloud beside cells that nobody coloured.
    let later = Model { header: Header { scan: 2, phase: Phase::End, ..Header::default() }, ..painted(Phase::End) };
    assert!(exporter.model(&later).unwrap().iter().all(|file| !file.path.ends_with("cloud.ply")));
    let blank = Model { texture: vec![[0; 4]; 2].into(), ..painted(Phase::End) };
    exporter.model(&blank).unwrap();
    assert_eq!(cloud::read(path).unwrap()[0].colour, [0; 4]);
}

#[test]
fn an_empty_scan_is_told_and_leaves_what_was_there() {
    let (folder, mut exporter) = exporter();
    exporter.mesh(&square(Phase::End)).unwrap();
    let path = folder.path().join("deep/out/mesh.ply");
    let before = fs::read(&path).unwrap();
    let empty =
        Mesh { vertices_m: vec![].into(), normals: vec![].into(), triangles: vec![].into(), ..square(Phase::End) };
    let error = exporter.mesh(&empty).unwrap_err().to_string();
    assert!(error.ends_with("mesh.ply: not written, because the scan has no surface"), "{error}");
    let error =
        exporter.model(&Model { mesh: empty, uv: vec![].into(), ..painted(Phase::End) }).unwrap_err().to_string();
    assert!(error.ends_with("model.glb: not written, because the scan has no surface"), "{error}");
    let error = exporter.cloud(&changes(Phase::End, 0, vec![])).unwrap_err().to_string();
    assert!(error.ends_with("cloud.ply: not written, because the cloud has no points"), "{error}");
    assert_eq!(fs::read(&path).unwrap(), before);
    assert_eq!(fs::read_dir(folder.path().join("deep/out")).unwrap().count(), 2);
}

#[test]
fn a_model_that_contradicts_itself_is_refused() {
    let (_folder, exporter) = exporter();
    let error = exporter.model(&Model { texture_width: 9, ..painted(Phase::End) }).unwrap_err().to_string();
    assert!(error.contains("its texture of 9x1 has 2 texels"), "{error}");
    let mut bad = painted(Phase::End);
    bad.mesh.triangles[0] = [0, 1, 7];
    assert!(exporter.model(&bad).unwrap_err().to_string().contains("face 0 names vertex 7, but there are 4"));
    bad.mesh.triangles[0] = [0, 1, 2];
    bad.mesh.vertices_m[3][0] = f32::NAN;
    assert!(exporter.model(&bad).unwrap_err().to_string().contains("vertex 3 is not finite"));
}
