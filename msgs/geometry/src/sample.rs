//! Points spread evenly over a surface.

use crate::{MeshError, MeshIndex, TriangleMesh, uniform};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

/// One point on a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceSample {
    /// In metres.
    pub point: Point3<f64>,
    /// The unit normal of its triangle.
    pub normal: Vector3<f64>,
    /// Which triangle.
    pub triangle: u32,
    /// The weights of the triangle's corners.
    pub barycentric: [f64; 3],
}

/// `count` points, uniform over the area: one at random in each of `count` strips of equal area, strung along the order
/// of the triangles (stratified, so that even few points cover all). The same seed gives the same points on any number
/// of threads; a mesh without area gives none.
pub fn sample_surface(mesh: &TriangleMesh, count: usize, seed: u64) -> Result<Vec<SurfaceSample>, MeshError> {
    mesh.check()?;
    let index: Vec<[Point3<f64>; 3]> =
        (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(|p| p.map(f64::from))).collect();
    Ok(sample_triangles(&index, count, seed))
}

impl MeshIndex {
    /// [`sample_surface`] on the mesh of this index.
    pub fn sample(&self, count: usize, seed: u64) -> Vec<SurfaceSample> {
        sample_triangles(self.triangles(), count, seed)
    }
}

fn sample_triangles(triangles: &[[Point3<f64>; 3]], count: usize, seed: u64) -> Vec<SurfaceSample> {
    let mut total = 0.0;
    let area_until: Vec<f64> = triangles
        .iter()
        .map(|[a, b, c]| {
            total += 0.5 * (b - a).cross(&(c - a)).norm();
            total
        })
        .collect();
    if total <= 0.0 {
        return Vec::new();
    }
    let sample = |i: usize| {
        let [strip, s, t] = [0, 1, 2].map(|k| uniform(seed, 3 * i as u64 + k));
        let area = (i as f64 + strip) / count as f64 * total;
        let triangle = area_until.partition_point(|&until| until <= area).min(triangles.len() - 1);
        let [a, b, c] = &triangles[triangle];
        // Osada et al. 2002, "Shape distributions", equation 1: uniform within a triangle.
        let root = s.sqrt();
        let weights = [1.0 - root, root * (1.0 - t), root * t];
        SurfaceSample {
            point: Point3::from(a.coords * weights[0] + b.coords * weights[1] + c.coords * weights[2]),
            normal: (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default(),
            triangle: triangle as u32,
            barycentric: weights,
        }
    };
    (0..count).into_par_iter().map(sample).collect()
}
