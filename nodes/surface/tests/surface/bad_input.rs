//! Clouds that have no surface, and numbers that are none.

use crate::animal::Random;
use crate::check::{as_it_is, assert_clean};
use proptest::prelude::*;
use surface::{Config, Surfer, surface_from_points};
use wire::{Cloud, CloudPoint, Extent, Header, TablePlane};

fn triangles(points: &[[f32; 3]], normals: Option<&[[f32; 3]]>) -> usize {
    surface_from_points(points, normals, as_it_is()).unwrap().0.triangles.len()
}

#[test]
fn too_few_points_have_no_surface() {
    assert_eq!(triangles(&[], None), 0);
    assert_eq!(triangles(&[[0.1, 0.2, 0.3]], Some(&[[0.0, 0.0, 1.0]])), 0);
    assert_eq!(triangles(&[[0.0; 3], [1.0; 3]], None), 0);
    assert_eq!(triangles(&[[0.1, 0.2, 0.3]; 500], Some(&[[0.0, 0.0, 1.0]; 500])), 0, "all in one place");
    let mut surfer = Surfer::new(Config::default()).unwrap();
    assert_eq!((surfer.live_mesh().triangles.len(), surfer.final_mesh().triangles.len()), (0, 0));
}

#[test]
fn points_on_a_line_have_no_surface() {
    let line: Vec<[f32; 3]> = (0..2000).map(|k| [k as f32 * 1e-4, 0.5 * k as f32 * 1e-4, 0.3]).collect();
    assert_eq!(triangles(&line, None), 0);
    assert_eq!(triangles(&line, Some(&vec![[0.0, 0.0, 1.0]; line.len()])), 0);
}

#[test]
fn duplicates_change_nothing_but_the_weight() {
    let mut random = Random(3);
    let once: Vec<[f32; 3]> =
        (0..5000).map(|_| [0.05 * random.even() as f32, 0.05 * random.even() as f32, 0.0]).collect();
    let twice: Vec<[f32; 3]> = once.iter().flat_map(|p| [*p, *p]).collect();
    let mesh = surface_from_points(&twice, None, Config::default()).unwrap().0;
    assert_clean(&mesh);
    assert!(mesh.triangles.len() > 500 && mesh.vertices_m.iter().all(|p| p[2].abs() < 1e-5));
}

#[test]
fn what_is_no_point_is_refused_and_counted() {
    let mut random = Random(3);
    let mut points: Vec<[f32; 3]> =
        (0..5000).map(|_| [0.05 * random.even() as f32, 0.05 * random.even() as f32, 0.0]).collect();
    let mut normals = vec![[0.0, 0.0, 1.0]; points.len()];
    let clean = surface_from_points(&points, Some(&normals), Config::default()).unwrap();
    assert!(clean.1.is_empty());
    points.extend([[f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0], [1e9, 0.0, 0.0], [0.0; 3]]);
    normals.extend([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [f32::NAN, 0.0, 0.0]]);
    let (mesh, refused) = surface_from_points(&points, Some(&normals), Config::default()).unwrap();
    assert_eq!(mesh, clean.0, "and the rest is as if they had never come");
    let counts: Vec<(&str, u64)> = refused.iter().map(|r| (r.reason.as_str(), r.count)).collect();
    assert_eq!(
        counts,
        [("position is not finite", 2), ("more than 1000 m from the origin", 1), ("normal is not finite", 1)]
    );
}

#[test]
fn impossible_settings_are_refused_by_name() {
    for (config, key) in [
        (Config { cell_mm: -1.0, ..Config::default() }, "cell_mm"),
        (Config { cell_mm: f64::NAN, ..Config::default() }, "cell_mm"),
        (Config { radius_mm: 1e9, ..Config::default() }, "radius_mm"),
        (Config { radius_mm: 1.0, cell_mm: 10.0, ..Config::default() }, "radius_mm"),
        (Config { fill_holes_mm: f64::INFINITY, ..Config::default() }, "fill_holes_mm"),
        (Config { drop_islands_mm: -3.0, ..Config::default() }, "drop_islands_mm"),
    ] {
        assert_eq!(Surfer::new(config).unwrap_err().key, key);
    }
}

fn number() -> impl Strategy<Value = f32> {
    prop_oneof![8 => -0.02f32..0.02, 1 => -900f32..900.0, 1 => any::<f32>()]
}

fn point() -> impl Strategy<Value = CloudPoint> {
    ([number(), number(), number()], [number(), number(), number()], any::<f32>(), prop_oneof![0..50u32, any::<u32>()])
        .prop_map(|(position_m, normal, sigma_m, id)| CloudPoint {
            position_m,
            normal,
            sigma_m,
            id,
            count: 1,
            spread_m: 0.0,
            colour: [0; 4],
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn hostile_clouds_give_a_clean_mesh_or_none(
        batches in prop::collection::vec((prop::collection::vec(point(), 0..200), any::<bool>()), 1..4),
        table in prop::option::of((prop_oneof![Just([0.0, 0.0, 1.0]), any::<[f64; 3]>()], prop_oneof![-0.02..0.02, any::<f64>()])),
    ) {
        let table = table.map(|(normal, distance_m)| TablePlane { normal, distance_m });
        let mut surfer = Surfer::new(Config { close: true, ..as_it_is() }).unwrap();
        for (points, whole) in batches {
            let extent = if whole { Extent::Whole } else { Extent::Changes };
            surfer.update(&Cloud { header: Header::default(), extent, table, points: points.into(), refused: Vec::new() });
            surfer.live_mesh();
        }
        assert_clean(&surfer.final_mesh());
    }
}
