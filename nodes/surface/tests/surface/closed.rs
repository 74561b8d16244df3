//! What nobody saw: closed by caps that are told apart from what was measured, and that the table bounds.

use crate::animal::{Random, V, animal, distance, on_animal, scanned};
use crate::check::{assert_clean, cloud};
use nalgebra::Rotation3;
use surface::{Config, Surfer};
use wire::{Cloud, Extent, Mesh, Refusal, TablePlane};

type Points = Vec<(V, V)>;

const RADIUS_M: f64 = 0.02;

fn made(truth: &Points, table: Option<TablePlane>, close: bool) -> (Mesh, Vec<Refusal>) {
    let (points, normals) = scanned(truth, 0.05e-3, 5.0, 9);
    let mut surfer = Surfer::new(Config { close, ..Config::default() }).unwrap();
    surfer.update(&Cloud { table, ..cloud(&points, &normals, Extent::Whole) });
    let mesh = surfer.final_mesh();
    let (on_rims, told) = (assert_clean(&mesh), surfer.refused());
    assert_eq!(on_rims == 0, close && told.is_empty(), "{on_rims} edges lie on rims; {told:?}");
    (mesh, told)
}

/// The vertices that only caps have.
fn guessed(mesh: &Mesh) -> Vec<V> {
    let measured = mesh.without_caps().vertices_m.len();
    mesh.vertices_m[measured..].iter().map(|p| V::from(p.map(f64::from))).collect()
}

fn sphere_above(height_m: f64) -> Points {
    let mut random = Random(3);
    let ball = std::iter::repeat_with(|| random.direction()).map(|n| (n * RADIUS_M, n));
    ball.filter(|(p, _)| p.z > height_m).take(25_000).collect()
}

#[test]
fn an_unseen_bottom_is_closed_and_what_was_measured_stays_as_it_was() {
    let truth = sphere_above(-0.6 * RADIUS_M);
    let open = made(&truth, None, false).0;
    assert_eq!(open.measured as usize, open.triangles.len());
    let (mesh, _) = made(&truth, None, true);
    assert!((mesh.measured as usize) < mesh.triangles.len());
    assert_eq!(mesh.without_caps(), open, "bit for bit");
    let bottom = guessed(&mesh);
    assert!(bottom.len() > 200);
    // A membrane over a circle is a disc.
    assert!(bottom.iter().all(|p| (p.z + 0.6 * RADIUS_M).abs() < 1e-3 && p.norm() < RADIUS_M + 1e-4));
    let down = mesh.normals.iter().skip(open.vertices_m.len()).filter(|n| n[2] < -0.9).count();
    assert!(down * 10 > bottom.len() * 9, "its normals point out");
}

#[test]
fn a_cylinder_stands_flat_on_its_table() {
    // The world is the tracker's: the table has any direction there. Nothing within 1.5 mm of it was seen.
    let world = Rotation3::from_euler_angles(0.3, -0.4, 0.5);
    let place = V::new(0.3, -0.2, 0.1);
    let mut random = Random(4);
    let truth: Points = (0..40_000)
        .map(|_| {
            let angle = std::f64::consts::TAU * random.even();
            let out = V::new(angle.cos(), angle.sin(), 0.0);
            let (p, n) = match random.even() < 0.2 {
                true => (out * (0.015 * random.even().sqrt()) + V::z() * 0.06, V::z()),
                false => (out * 0.015 + V::z() * (1.5e-3 + 58.5e-3 * random.even()), out),
            };
            (world * p + place, world * n)
        })
        .collect();
    let normal = world * V::z();
    let table = TablePlane { normal: normal.into(), distance_m: normal.dot(&place) };
    let height_m = |p: &V| normal.dot(p) - table.distance_m;
    let sole = guessed(&made(&truth, Some(table), true).0);
    assert!(sole.len() > 200 && sole.iter().all(|p| height_m(p).abs() < 1e-6), "flat, and at the table's height");
    let hanging = guessed(&made(&truth, None, true).0);
    assert!(hanging.iter().all(|p| height_m(p) > 0.5e-3), "without a table nobody knows how far down it goes");
}

#[test]
fn a_rim_in_several_planes_is_closed_above_the_table() {
    // Seen from above and around, on the plinth as its table: not the belly, nor the legs' inner sides.
    const TABLE_M: f64 = 0.01;
    let inner = |p: &V, n: &V| n.z < -0.7 || (p.z < 0.045 && n.y * p.y.signum() < -0.6);
    let all = on_animal(120_000, 5).into_iter();
    let truth: Points = all.filter(|(p, n)| p.z > TABLE_M + 0.5e-3 && !inner(p, n)).collect();
    let table = TablePlane { normal: [0.0, 0.0, 1.0], distance_m: TABLE_M };
    let (mesh, told) = made(&truth, Some(table), true);
    assert!(told.is_empty(), "{told:?}");
    let caps = guessed(&mesh);
    assert!(caps.iter().all(|p| p.z > TABLE_M - 1e-6), "nothing is below the table");
    assert!(caps.iter().filter(|p| p.z < TABLE_M + 1e-6).count() > 100, "it stands on it");
    let mut off: Vec<f64> = caps.iter().map(|p| distance(animal, p).abs()).collect();
    off.sort_by(f64::total_cmp);
    assert!(off[off.len() / 2] < 3e-3, "{}", off[off.len() / 2]);
}

#[test]
fn a_wall_and_a_half_are_left_open_and_told() {
    let mut random = Random(6);
    let wall: Points = (0..8000).map(|_| (V::new(0.05 * random.even(), 0.05 * random.even(), 0.0), V::z())).collect();
    let half = sphere_above(0.0);
    for truth in [&wall, &half] {
        let (mesh, told) = made(truth, None, true);
        assert_eq!(mesh.measured as usize, mesh.triangles.len());
        assert!(told[0].count == 1 && told[0].reason.contains("hole left open"), "{told:?}");
    }
    // The half that stands on a table has a flat face there.
    let table = TablePlane { normal: [0.0, 0.0, 1.0], distance_m: 0.0 };
    let face = guessed(&made(&half, Some(table), true).0);
    assert!(face.len() > 200 && face.iter().all(|p| p.z.abs() < 1e-6));
}
