//! Scenes: the cow is one closed surface, files and bad files are understood, the same seed gives the same bytes.
#![allow(clippy::unwrap_used, reason = "a test helper that cannot go on fails the test")]

use geometry::TriangleMesh;
use nalgebra::Point3;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::LazyLock;
use world::{Scene, SceneError};

static COW: LazyLock<Scene> = LazyLock::new(|| Scene::cow().unwrap());

/// One number for each place, so that vertices that paint has doubled count once.
fn welded(mesh: &TriangleMesh) -> Vec<[usize; 3]> {
    let mut places = BTreeMap::new();
    let of = |p: &Point3<f32>| [p.x, p.y, p.z].map(f32::to_bits);
    let numbers: Vec<usize> = mesh
        .vertices
        .iter()
        .map(|p| {
            let next = places.len();
            *places.entry(of(p)).or_insert(next)
        })
        .collect();
    mesh.triangles.iter().map(|t| t.map(|i| numbers[i as usize])).collect()
}

/// Closed and oriented: each directed edge once, and its opposite once. Manifold: the triangles of a vertex are one fan.
fn assert_closed_manifold(mesh: &TriangleMesh) -> i64 {
    let triangles = welded(mesh);
    let mut edges = BTreeSet::new();
    let mut fans: BTreeMap<usize, BTreeMap<usize, usize>> = BTreeMap::new();
    for [a, b, c] in &triangles {
        for (from, to, other) in [(*a, *b, *c), (*b, *c, *a), (*c, *a, *b)] {
            assert!(from != to, "a triangle without area");
            assert!(edges.insert((from, to)), "two triangles on one side of an edge");
            fans.entry(from).or_default().insert(to, other);
        }
    }
    assert!(edges.iter().all(|&(from, to)| edges.contains(&(to, from))), "an open edge");
    for (vertex, fan) in &fans {
        let (&start, _) = fan.iter().next().unwrap();
        let mut at = start;
        let mut steps = 0;
        while steps == 0 || at != start {
            at = fan[&at];
            steps += 1;
        }
        assert_eq!(steps, fan.len(), "two fans at vertex {vertex}");
    }
    fans.len() as i64 - edges.len() as i64 / 2 + triangles.len() as i64
}

#[test]
fn the_cow_is_one_closed_surface_of_the_right_size() {
    let mesh = &COW.subject().mesh;
    mesh.check().unwrap();
    assert_eq!(assert_closed_manifold(mesh), 2, "like a ball: no holes through it, one piece");
    let [low, high] = mesh.bounds().unwrap();
    assert!(((high - low).max() - 0.15).abs() < 1e-4);
    assert!(low.z.abs() < 1e-6, "it stands on the table");
    assert!(mesh.triangles.len() < 80_000);
    assert_eq!(mesh.colours.len(), mesh.vertices.len());
    let smallest = (0..mesh.triangles.len()).map(|t| mesh.area_normal(t).norm()).fold(f32::INFINITY, f32::min);
    assert!(smallest > 0.0, "a sliver without area");
}

#[test]
fn each_triangle_has_one_colour_and_there_are_many() {
    let mesh = &COW.subject().mesh;
    let mut areas: BTreeMap<[u8; 3], f64> = BTreeMap::new();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|i| mesh.colours[i as usize]);
        assert!(a == b && b == c);
        *areas.entry(a).or_default() += 0.5 * f64::from(mesh.area_normal(t).norm());
    }
    let whole: f64 = areas.values().sum();
    let shares: Vec<f64> = areas.values().map(|area| area / whole).collect();
    assert!(shares.iter().filter(|share| **share > 0.05).count() >= 3, "{areas:?}");
}

#[test]
fn normals_agree_with_the_triangles() {
    let mesh = &COW.subject().mesh;
    let off = mesh.triangles.iter().enumerate().filter(|(t, triangle)| {
        let flat = mesh.area_normal(*t);
        triangle.iter().any(|&i| flat.dot(&mesh.normals[i as usize]) < 0.5 * flat.norm())
    });
    let share = off.count() as f64 / mesh.triangles.len() as f64;
    assert!(share < 0.01, "{share}");
}

#[test]
fn the_same_scene_twice_is_the_same() {
    assert_eq!(*COW, Scene::cow().unwrap());
}

#[test]
fn the_scene_files_can_be_read() {
    for (name, subject) in [("cow", "cow"), ("tabletop", "all")] {
        let path = format!("{}/../../config/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let scene = Scene::load(Path::new(&path)).unwrap();
        assert_eq!(scene.subject().name, subject);
        assert_eq!(scene.table.map(|at| scene.surfaces[at].name.as_str()), Some("table"));
        for surface in &scene.surfaces {
            surface.mesh.check().unwrap();
            if let Some(texture) = &surface.texture {
                assert_eq!(texture.rgb.len(), texture.width * texture.height);
                assert_eq!(surface.mesh.uv.len(), surface.mesh.vertices.len());
            }
        }
    }
}

fn refusal(text: &str) -> String {
    Scene::parse(text, Path::new("nowhere")).unwrap_err().to_string()
}

#[test]
fn bad_scene_files_say_what_is_wrong() {
    let cow = "[[object]]\nkind = \"cow\"\n";
    for (text, words) in [
        ("", vec!["nothing to scan"]),
        ("[[object]]\nkind = \"horse\"\n", vec!["kind"]),
        (&format!("colour = 3\n{cow}"), vec!["colour", "expected"]),
        (&format!("{cow}size_m = 2\n"), vec!["size_m", "size_mm"]),
        (&format!("{cow}size_mm = nan\n"), vec!["cow", "size_mm", "10 to 2000"]),
        (&format!("{cow}at_mm = [0, inf]\n"), vec!["at_mm"]),
        (&format!("{cow}file = \"x.obj\"\n"), vec!["mesh"]),
        (&format!("subject = \"pig\"\n{cow}"), vec!["pig", "cow"]),
        (&format!("ambient = -1\n{cow}"), vec!["ambient"]),
        (&format!("{cow}[hand]\nstand_off_mm = 5\n"), vec!["stand_off_mm", "80 to 600"]),
        (&format!("{cow}[table]\nsize_mm = [0, 3]\n"), vec!["table", "size_mm"]),
        ("[[object]]\nkind = \"mesh\"\n", vec!["needs a file"]),
        ("[[object]]\nkind = \"mesh\"\nfile = \"none.obj\"\nsize_mm = 100\n", vec!["none.obj", "No such file"]),
        ("[[object]]\nkind = \"mesh\"\nfile = \"none.doc\"\nsize_mm = 100\n", vec!["none.doc", "obj, ply, stl, glb"]),
    ] {
        let said = refusal(text);
        assert!(words.iter().all(|word| said.contains(word)), "{text:?} gave {said:?}, wanted {words:?}");
    }
    let missing = Scene::load(Path::new("/nowhere/scene.toml")).unwrap_err();
    assert!(matches!(missing, SceneError::Read { .. }) && missing.to_string().contains("/nowhere/scene.toml"));
}

#[test]
fn a_users_mesh_is_scaled_and_set_on_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wedge.obj");
    std::fs::write(&file, "v 0 0 0\nv 4 0 0\nv 0 1 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n").unwrap();
    let scene = Scene::with_object(&file, 80.0).unwrap();
    let [low, high] = scene.subject().mesh.bounds().unwrap();
    assert!((high - low - nalgebra::Vector3::new(0.08, 0.02, 0.04)).norm() < 1e-6);
    assert!(low.z.abs() < 1e-7 && (low.x + high.x).abs() < 1e-7);
    assert_eq!(assert_closed_manifold(&scene.subject().mesh), 2);

    for (name, text, word) in [
        ("points.obj", "v 0 0 0\nv 1 0 0\n", "without faces"),
        ("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite"),
        ("point.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "one point"),
    ] {
        let file = folder.path().join(name);
        std::fs::write(&file, text).unwrap();
        let said = Scene::with_object(&file, 80.0).unwrap_err().to_string();
        assert!(said.contains(word) && said.contains(name), "{name}: {said}");
    }
}
