//! A model laid onto the truth: what is left is the error of its shape.

use anyhow::Result;
use geometry::{METRES_PER_MM, TriangleMesh};
use nalgebra::{Isometry3, Point3};
use report::Aligned;

/// Moves the mesh, and says how far.
pub fn lay_onto(
    mesh: &mut TriangleMesh,
    truth: &TriangleMesh,
    seen: &[bool],
    seed: u64,
) -> Result<(Isometry3<f64>, Aligned)> {
    let found = geometry::align(mesh, truth, &Isometry3::identity(), seed)?;
    let onto = found.truth_from_model;
    let middle = mesh.bounds().map_or(Point3::origin(), |[low, high]| nalgebra::center(&low, &high).cast());
    let moved_mm = (onto * middle - middle).norm() / METRES_PER_MM;
    move_by(mesh, &onto);
    let comparison = geometry::compare(mesh, truth, Some(seen), seed)?;
    Ok((onto, Aligned { moved_mm, turned_deg: onto.rotation.angle().to_degrees(), comparison }))
}

/// Moves a mesh.
pub fn move_by(mesh: &mut TriangleMesh, by: &Isometry3<f64>) {
    mesh.vertices.iter_mut().for_each(|p| *p = (by * p.cast::<f64>()).cast());
    let turn = by.rotation.cast::<f32>();
    mesh.normals.iter_mut().for_each(|n| *n = turn * *n);
}
