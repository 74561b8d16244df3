//! Rays against a mesh and the closest points on it.

use crate::{MeshError, TriangleMesh};
use nalgebra::{Point3, Vector3};
use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector as Vec3;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhLeafCost, BvhNode};
use parry3d::query::{PointQuery, Ray};

/// Finds triangles fast: a tree of boxes (parry3d) over triangles that are kept and intersected in f64.
///
/// ```
/// use geometry::{MeshIndex, TriangleMesh};
/// use nalgebra::{Point3, Vector3};
/// let mesh = TriangleMesh {
///     vertices: vec![Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)],
///     triangles: vec![[0, 1, 2]],
///     ..TriangleMesh::default()
/// };
/// let index = MeshIndex::new(&mesh).unwrap();
/// let hit = index.cast(&Point3::new(0.2, 0.2, 1.0), &Vector3::new(0.0, 0.0, -1.0), 10.0).unwrap();
/// assert!((hit.distance - 1.0).abs() < 1e-12);
/// let closest = index.closest(&Point3::new(-3.0, 0.0, 4.0)).unwrap();
/// assert!((closest.distance - 5.0).abs() < 1e-12);
/// ```
#[derive(Clone)]
pub struct MeshIndex {
    triangles: Vec<[Point3<f64>; 3]>,
    tree: Bvh,
    /// The tree thinks in f32 about the middle of the mesh, so that millimetres far from the origin keep their digits.
    middle: Point3<f64>,
}

/// Where a ray met the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// In lengths of the direction that was cast (metres for a unit vector).
    pub distance: f64,
    /// Which triangle.
    pub triangle: u32,
    /// Where.
    pub point: Point3<f64>,
}

/// The point of the mesh that is closest to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closest {
    /// In metres.
    pub distance: f64,
    /// Which triangle (on an edge or a corner: one of those that share it).
    pub triangle: u32,
    /// Where.
    pub point: Point3<f64>,
}

impl BvhLeafCost for Closest {
    fn cost(&self) -> f32 {
        self.distance as f32
    }
}

/// Boxes are this much larger than their triangles (of the mesh's diagonal), so that f32 prunes nothing that f64 would hit.
const BOX_SLACK: f32 = 1e-6;
/// A ray that runs into the edge between two triangles must hit one of them (barycentric).
const EDGE_SLACK: f64 = 1e-9;

fn narrow(v: Vector3<f64>) -> Vec3 {
    Vec3::new(v.x as f32, v.y as f32, v.z as f32)
}

impl MeshIndex {
    /// Builds the tree; refuses what [`TriangleMesh::check`] refuses.
    pub fn new(mesh: &TriangleMesh) -> Result<Self, MeshError> {
        mesh.check()?;
        let triangles: Vec<_> = (0..mesh.triangles.len()).map(|t| mesh.corners(t).map(|p| p.map(f64::from))).collect();
        let [low, high] = mesh.bounds().unwrap_or_default().map(|p| p.map(f64::from));
        let middle = nalgebra::center(&low, &high);
        let slack = Vec3::splat(BOX_SLACK * ((high - low).norm() as f32).max(f32::MIN_POSITIVE));
        let boxes = triangles.iter().map(|corners: &[Point3<f64>; 3]| {
            let [a, b, c] = corners.map(|p| narrow(p - middle));
            Aabb::new(a.min(b).min(c) - slack, a.max(b).max(c) + slack)
        });
        let tree = Bvh::from_iter(BvhBuildStrategy::Binned, boxes.enumerate());
        Ok(Self { triangles, tree, middle })
    }

    /// The first triangle, from either side, on the ray `origin + t direction` with 0 <= t < `max_distance`, where t is in
    /// lengths of `direction`. Nothing is hit by a ray that is not finite or has no direction.
    pub fn cast(&self, origin: &Point3<f64>, direction: &Vector3<f64>, max_distance: f64) -> Option<Hit> {
        let finite = origin.coords.iter().chain(direction.iter()).all(|c| c.is_finite());
        if !finite || direction.norm_squared() == 0.0 {
            return None;
        }
        // The tree wants a unit vector: it takes small components for zero.
        let norm = direction.norm();
        let ray = Ray::new(narrow(origin - self.middle), narrow(direction / norm));
        let reach = (max_distance * norm).min(f64::from(f32::MAX)) as f32;
        let leaf = |t: u32, _| {
            let distance = intersect(&self.triangles[t as usize], origin, direction)?;
            (distance < max_distance).then_some((distance * norm) as f32)
        };
        let (triangle, _) = self.tree.cast_ray(&ray, reach, leaf)?;
        let distance = intersect(&self.triangles[triangle as usize], origin, direction)?;
        Some(Hit { distance, triangle, point: origin + direction * distance })
    }

    /// The closest point of the mesh; `None` only for a point that is not finite.
    pub fn closest(&self, point: &Point3<f64>) -> Option<Closest> {
        self.closest_within(point, f64::INFINITY)
    }

    /// The closest point of the mesh nearer than `max_distance`, if there is one. Faster than [`Self::closest`] for far points.
    pub fn closest_within(&self, point: &Point3<f64>, max_distance: f64) -> Option<Closest> {
        if !point.coords.iter().all(|c| c.is_finite()) {
            return None;
        }
        let p = narrow(point - self.middle);
        let reach = max_distance.min(f64::from(f32::MAX)) as f32;
        let enter = |node: &BvhNode, _| node.aabb().distance_to_local_point(p, true);
        let leaf = |t: u32, _| {
            let on_triangle = closest_on_triangle(point, &self.triangles[t as usize]);
            Some(Closest { distance: (on_triangle - point).norm(), triangle: t, point: on_triangle })
        };
        self.tree.find_best(reach, enter, leaf).map(|(_, closest)| closest)
    }

    /// The corners of all triangles, in the order of the mesh.
    pub fn triangles(&self) -> &[[Point3<f64>; 3]] {
        &self.triangles
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> &[Point3<f64>; 3] {
        &self.triangles[triangle as usize]
    }

    /// The unit normal of a triangle, or zero where it has no area.
    pub fn normal(&self, triangle: u32) -> Vector3<f64> {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default()
    }

    /// The weights of the corners that give a point of a triangle; the first corner where it has no area.
    pub fn barycentric(&self, triangle: u32, point: &Point3<f64>) -> [f64; 3] {
        let [a, b, c] = self.corners(triangle);
        let normal = (b - a).cross(&(c - a));
        let double_area = normal.norm_squared();
        if double_area == 0.0 {
            return [1.0, 0.0, 0.0];
        }
        let v = (point - a).cross(&(c - a)).dot(&normal) / double_area;
        let w = (b - a).cross(&(point - a)).dot(&normal) / double_area;
        [1.0 - v - w, v, w]
    }
}

/// Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection", from both sides.
fn intersect([a, b, c]: &[Point3<f64>; 3], origin: &Point3<f64>, direction: &Vector3<f64>) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(&ac);
    let determinant = ab.dot(&across);
    if determinant == 0.0 {
        return None;
    }
    let from_a = origin - a;
    let u = from_a.dot(&across) / determinant;
    let along = from_a.cross(&ab);
    let v = direction.dot(&along) / determinant;
    let distance = ac.dot(&along) / determinant;
    let inside = u >= -EDGE_SLACK && v >= -EDGE_SLACK && u + v <= 1.0 + EDGE_SLACK && distance >= 0.0;
    inside.then_some(distance)
}

/// Ericson 2004, "Real-Time Collision Detection", section 5.1.5: the Voronoi regions of corners, edges and face in turn.
fn closest_on_triangle(p: &Point3<f64>, [a, b, c]: &[Point3<f64>; 3]) -> Point3<f64> {
    let (ab, ac) = (b - a, c - a);
    let ap = p - a;
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let scale = 1.0 / (va + vb + vc);
    a + ab * (vb * scale) + ac * (vc * scale)
}
