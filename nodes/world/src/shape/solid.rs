//! Signed distances of simple solids: negative inside, in millimetres. All are exact or slightly too short near the
//! surface, which is all that [`surface_nets`](super::surface_nets) needs.

use nalgebra::{Point3, Vector2, Vector3};

pub type Point = Point3<f64>;

/// A ball.
pub fn sphere(p: &Point, centre: [f64; 3], radius: f64) -> f64 {
    (p - Point::from(centre)).norm() - radius
}

/// An ellipsoid along the axes: first-order distance, exact on the surface.
pub fn ellipsoid(p: &Point, centre: [f64; 3], radii: [f64; 3]) -> f64 {
    let q = p - Point::from(centre);
    let radii = Vector3::from(radii);
    let scaled = q.component_div(&radii);
    let gradient = scaled.component_div(&radii).norm();
    let level = scaled.norm();
    if gradient < 1e-12 { -radii.min() } else { level * (level - 1.0) / gradient }
}

/// A limb: round, from `a` to `b`, its radius going evenly from `radius_a` to `radius_b`.
pub fn limb(p: &Point, a: [f64; 3], b: [f64; 3], radius_a: f64, radius_b: f64) -> f64 {
    let (a, b) = (Point::from(a), Point::from(b));
    let axis = b - a;
    let at = ((p - a).dot(&axis) / axis.norm_squared()).clamp(0.0, 1.0);
    (p - (a + axis * at)).norm() - (radius_a + (radius_b - radius_a) * at)
}

/// A box with rounded edges, half as long as `half` says on each side of its centre.
pub fn rounded_box(p: &Point, centre: [f64; 3], half: [f64; 3], edge: f64) -> f64 {
    let q = (p - Point::from(centre)).abs() - Vector3::from(half) + Vector3::repeat(edge);
    q.sup(&Vector3::zeros()).norm() + q.max().min(0.0) - edge
}

/// An upright cylinder with rounded rims, between two heights.
pub fn cylinder(p: &Point, radius: f64, [low, high]: [f64; 2], rim: f64) -> f64 {
    let middle = 0.5 * (low + high);
    let q = Vector2::new(p.coords.xy().norm() - radius + rim, (p.z - middle).abs() - 0.5 * (high - low) + rim);
    q.sup(&Vector2::zeros()).norm() + q.max().min(0.0) - rim
}

/// A ring in the plane of x and z.
pub fn upright_ring(p: &Point, centre: [f64; 3], radius: f64, thickness: f64) -> f64 {
    let q = p - Point::from(centre);
    (q.x.hypot(q.z) - radius).hypot(q.y) - thickness
}

/// Both, with a fillet about as wide as `fillet`.
pub fn union(a: f64, b: f64, fillet: f64) -> f64 {
    let near = (fillet - (a - b).abs()).max(0.0);
    a.min(b) - 0.25 * near * near / fillet
}

/// `a` without `b`, with a rounded edge.
pub fn without(a: f64, b: f64, fillet: f64) -> f64 {
    -union(-a, b, fillet)
}
