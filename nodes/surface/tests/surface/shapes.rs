//! Surfaces whose truth is a formula.

use crate::animal::{Random, V, animal, distance, on_animal, scanned};
use crate::check::{as_it_is, assert_clean, errors_m, quantile};
use surface::{Config, surface_from_points};
use wire::Mesh;

type Points = (Vec<[f32; 3]>, Vec<[f32; 3]>);

fn surface(points: &Points, config: Config) -> Mesh {
    surface_from_points(&points.0, Some(&points.1), config).unwrap().0
}

fn scan(count: usize, noise_m: f64, on_surface: impl Fn(&mut Random) -> (V, V)) -> Points {
    let mut random = Random(7);
    let truth: Vec<(V, V)> = (0..count).map(|_| on_surface(&mut random)).collect();
    scanned(&truth, noise_m, 5.0, 8)
}

fn sphere(random: &mut Random) -> (V, V) {
    let n = random.direction();
    (n * 0.02 + V::new(0.1, 0.2, 0.3), n)
}

fn off_sphere([x, y, z]: [f64; 3]) -> f64 {
    (V::new(x, y, z) - V::new(0.1, 0.2, 0.3)).norm() - 0.02
}

#[test]
fn a_plane_is_flat_and_ends_where_its_samples_end() {
    let points = scan(20_000, 0.1e-3, |r| (V::new(0.1 * r.even(), 0.06 * r.even(), 0.0), V::z()));
    let mesh = surface(&points, Config::default());
    assert!(assert_clean(&mesh) > 100, "a plane has a rim");
    let errors = errors_m(&mesh, |p| p[2]);
    assert!(quantile(&errors, 0.95) < 0.085e-3, "{}", quantile(&errors, 0.95));
    let reach_m = 1e-3;
    let inside = |p: &[f32; 3]| p[0] > -reach_m && p[0] < 0.1 + reach_m && p[1] > -reach_m && p[1] < 0.06 + reach_m;
    assert!(mesh.vertices_m.iter().all(inside), "nothing is invented beyond the reach of the samples");
    assert!(mesh.normals.iter().all(|n| n[2] > 0.8));
}

#[test]
fn a_sphere_is_closed_and_round() {
    let mesh = surface(&scan(30_000, 0.1e-3, sphere), Config::default());
    assert_eq!(assert_clean(&mesh), 0, "closed");
    let errors = errors_m(&mesh, off_sphere);
    assert!(quantile(&errors, 0.95) < 0.065e-3, "{}", quantile(&errors, 0.95));
    // Curvature is corrected for: the mean must not be drawn inside.
    let signed: f64 = mesh.vertices_m.iter().map(|p| off_sphere(p.map(f64::from))).sum::<f64>();
    assert!((signed / mesh.vertices_m.len() as f64).abs() < 0.008e-3);
    let outwards = |(p, n): (&[f32; 3], &[f32; 3])| {
        (V::from(p.map(f64::from)) - V::new(0.1, 0.2, 0.3)).normalize().dot(&V::from(n.map(f64::from))) > 0.98
    };
    assert!(mesh.vertices_m.iter().zip(mesh.normals.iter()).all(outwards));
}

#[test]
fn sigma_tells_the_error() {
    let mesh = surface(&scan(30_000, 0.1e-3, sphere), Config::default());
    let squares: f64 = mesh.vertices_m.iter().map(|p| off_sphere(p.map(f64::from)).powi(2)).sum();
    let rms = (squares / mesh.vertices_m.len() as f64).sqrt();
    let stated = mesh.sigma_m.iter().map(|&s| f64::from(s)).sum::<f64>() / mesh.sigma_m.len() as f64;
    assert!(rms < 1.3 * stated && stated < 3.0 * rms, "rms {rms}, stated {stated}");
}

#[test]
fn a_cylinder_is_open_at_its_ends() {
    let points = scan(40_000, 0.1e-3, |r| {
        let angle = std::f64::consts::TAU * r.even();
        let n = V::new(angle.cos(), angle.sin(), 0.0);
        (n * 0.015 + V::z() * 0.06 * r.even(), n)
    });
    let mesh = surface(&points, Config::default());
    assert!(assert_clean(&mesh) > 40);
    let inner: Vec<f64> = {
        let off = |p: [f64; 3]| if (0.002..0.058).contains(&p[2]) { p[0].hypot(p[1]) - 0.015 } else { 0.0 };
        errors_m(&mesh, off)
    };
    assert!(quantile(&inner, 0.95) < 0.06e-3, "{}", quantile(&inner, 0.95));
    let closed = surface(&points, Config { fill_holes_mm: 100.0, ..Config::default() });
    assert_eq!(assert_clean(&closed), 0, "a large value closes the ends");
    let cap = closed.vertices_m.iter().filter(|p| p[0].hypot(p[1]) < 0.007);
    assert!(cap.clone().count() > 20 && cap.clone().all(|p| (0.03 - p[2]).abs() < 0.034));
}

/// Two sheets, each seen from its own side, outwards.
fn plate(random: &mut Random, thickness_m: f64, back_to_back: bool) -> (V, V) {
    let up = if random.even() < 0.5 { 1.0 } else { -1.0 };
    let side = if back_to_back { up } else { -up };
    (V::new(0.05 * random.even(), 0.05 * random.even(), 0.5 * thickness_m * up), V::z() * side)
}

#[test]
fn thin_plates_and_narrow_gaps_stay_apart() {
    for back_to_back in [true, false] {
        for thickness_m in [3e-3, 2e-3] {
            let points = scan(10_000, 0.1e-3, |r| plate(r, thickness_m, back_to_back));
            let mesh = surface(&points, as_it_is());
            assert_clean(&mesh);
            let inner = |p: [f64; 3]| {
                let edge = p[0].min(p[1]).min(0.05 - p[0]).min(0.05 - p[1]) < 1e-3;
                if edge { 0.0 } else { p[2].abs() - 0.5 * thickness_m }
            };
            let errors = errors_m(&mesh, inner);
            assert!(quantile(&errors, 0.999) < 0.25e-3, "{thickness_m} {back_to_back} {}", quantile(&errors, 0.999));
        }
    }
}

#[test]
fn sheets_seen_from_one_side_have_no_phantom_between_them() {
    let points = scan(10_000, 0.1e-3, |r| {
        let z = if r.even() < 0.5 { 0.0 } else { 4e-3 };
        (V::new(0.05 * r.even(), 0.05 * r.even(), z), V::z())
    });
    let mesh = surface(&points, as_it_is());
    assert_clean(&mesh);
    let worst = errors_m(&mesh, |p| p[2].abs().min((p[2] - 4e-3).abs()));
    // The most is at the rims, where the last samples stand to one side.
    assert!(quantile(&worst, 1.0) < 0.7e-3, "{}", quantile(&worst, 1.0));
}

#[test]
fn a_cloud_without_normals_is_turned_outwards() {
    let (points, _) = scan(30_000, 0.05e-3, sphere);
    let (mesh, _) = surface_from_points(&points, None, Config::default()).unwrap();
    assert_eq!(assert_clean(&mesh), 0);
    assert!(quantile(&errors_m(&mesh, off_sphere), 0.95) < 0.05e-3);
    let volume: f64 = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| V::from(mesh.vertices_m[v as usize].map(f64::from)));
            a.dot(&b.cross(&c)) / 6.0
        })
        .sum();
    let true_volume = 4.0 / 3.0 * std::f64::consts::PI * 0.02f64.powi(3);
    assert!((volume / true_volume - 1.0).abs() < 0.01, "{}", volume / true_volume);
}

#[test]
fn an_animal_comes_out_true() {
    let (points, normals) = scanned(&on_animal(80_000, 3), 0.1e-3, 5.0, 4);
    let mesh = surface(&(points, normals), Config::default());
    assert_clean(&mesh);
    let errors = errors_m(&mesh, |p| distance(animal, &V::from(p)));
    assert!(quantile(&errors, 0.95) < 0.1e-3, "{}", quantile(&errors, 0.95));
    assert!(quantile(&errors, 0.999) < 1e-3, "{}", quantile(&errors, 0.999));
}
