//! What every test asks of a mesh.

use std::collections::HashMap;
use surface::Config;
use wire::{Cloud, CloudPoint, Extent, Header, Mesh};

/// Distances in metres, of vertices and of the middles of triangles, from a true surface.
pub fn errors_m(mesh: &Mesh, distance: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
    let at = |v: u32| mesh.vertices_m[v as usize].map(f64::from);
    let middle = |&[a, b, c]: &[u32; 3]| [0, 1, 2].map(|k| (at(a)[k] + at(b)[k] + at(c)[k]) / 3.0);
    let vertices = (0..mesh.vertices_m.len() as u32).map(at);
    let mut errors: Vec<f64> = vertices.chain(mesh.triangles.iter().map(middle)).map(|p| distance(p).abs()).collect();
    errors.sort_by(f64::total_cmp);
    errors
}

/// The error that this share of the mesh does not exceed.
pub fn quantile(errors: &[f64], share: f64) -> f64 {
    errors[((errors.len() - 1) as f64 * share) as usize]
}

/// Holds what a clean mesh promises; returns how many edges lie on a rim.
pub fn assert_clean(mesh: &Mesh) -> usize {
    let count = mesh.vertices_m.len();
    assert_eq!((mesh.normals.len(), mesh.sigma_m.len()), (count, count));
    assert!(mesh.vertices_m.iter().flatten().all(|x| x.is_finite()));
    assert!(mesh.sigma_m.iter().all(|s| s.is_finite() && *s >= 0.0));
    let length = |n: &[f32; 3]| n.iter().map(|x| x * x).sum::<f32>().sqrt();
    assert!(mesh.normals.iter().all(|n| (length(n) - 1.0).abs() < 1e-3), "normals are unit vectors");
    let mut uses: HashMap<(u32, u32), u32> = HashMap::new();
    for &[a, b, c] in mesh.triangles.iter() {
        assert!(a != b && b != c && c != a && [a, b, c].iter().all(|&v| (v as usize) < count));
        for edge in [(a, b), (b, c), (c, a)] {
            *uses.entry(edge).or_default() += 1;
        }
    }
    // Each direction of an edge at most once: two triangles at most, and they agree on which side is out.
    assert!(uses.values().all(|&n| n == 1), "an edge has three triangles or two that disagree");
    assert_one_fan_each(mesh);
    uses.keys().filter(|(a, b)| !uses.contains_key(&(*b, *a))).count()
}

/// No bow-ties: around every vertex the triangles form one fan.
fn assert_one_fan_each(mesh: &Mesh) {
    let mut around: Vec<Vec<(u32, u32)>> = vec![Vec::new(); mesh.vertices_m.len()];
    for &[a, b, c] in mesh.triangles.iter() {
        for (v, next, last) in [(a, b, c), (b, c, a), (c, a, b)] {
            around[v as usize].push((next, last));
        }
    }
    for (v, mut left) in around.into_iter().enumerate() {
        let Some((mut first, mut last)) = left.pop() else { panic!("vertex {v} has no triangle") };
        while let Some(k) = left.iter().position(|&(next, before)| next == last || before == first) {
            let (next, before) = left.swap_remove(k);
            if next == last { last = before } else { first = next }
        }
        assert!(left.is_empty(), "vertex {v} joins two fans");
    }
}

/// A cloud message of points with normals.
pub fn cloud(points: &[[f32; 3]], normals: &[[f32; 3]], extent: Extent) -> Cloud {
    let point = |((&position_m, &normal), id)| CloudPoint {
        position_m,
        normal,
        id,
        count: 1,
        colour: [0; 4],
        spread_m: 0.0,
        sigma_m: 0.0,
    };
    let points = points.iter().zip(normals).zip(0..).map(point).collect();
    Cloud { header: Header::default(), extent, table: None, points, refused: Vec::new() }
}

/// Without dropping or filling anything.
pub fn as_it_is() -> Config {
    Config { drop_islands_mm: 0.0, fill_holes_mm: 0.0, ..Config::default() }
}
