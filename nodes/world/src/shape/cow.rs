//! A toy cow (the paper's figure 2 shows one): about 150 mm long, cast in one piece, standing on z = 0, looking along x.

use super::solid::{Point, ellipsoid, limb, sphere, union};
use super::{Coat, paint, surface_nets};
use geometry::TriangleMesh;
use nalgebra::{Rotation3, Vector3};

/// Edge of a cell of the mesh.
const CELL_MM: f64 = 1.5;
/// Trunk and head stand this much higher than their numbers say, so that a scanner can look under the belly.
const LIFT_MM: f64 = 6.0;
/// The head turns to its left about this upright axis.
const HEAD_PIVOT: [f64; 3] = [52.0, 0.0, 84.0];
const HEAD_TURN_DEG: f64 = 14.0;

/// The cow, painted, in millimetres.
pub fn cow() -> TriangleMesh {
    let bounds = [Point::new(-74.0, -34.0, -1.0), Point::new(92.0, 34.0, 124.0)];
    let mesh = surface_nets(distance, bounds, CELL_MM);
    let coat: Coat = super::cow_coat::coat();
    paint(mesh, &coat)
}

/// Where a point of the trunk was before it was lifted.
pub fn in_trunk(p: &Point) -> Point {
    p - LIFT_MM * Vector3::z()
}

/// Where a point of the trunk was before its head was turned; what is painted on the head turns with it.
pub fn in_head(p: &Point) -> Point {
    let pivot = Point::from(HEAD_PIVOT);
    pivot + Rotation3::from_axis_angle(&Vector3::z_axis(), -HEAD_TURN_DEG.to_radians()) * (p - pivot)
}

fn distance(p: &Point) -> f64 {
    let q = in_trunk(p);
    let trunk = union(body(&q), neck(&q), 14.0);
    let whole = union(trunk, head(&in_head(&q)), 7.0);
    let whole = union(whole, legs(p), 9.0);
    let whole = union(whole, udder(&q), 5.0);
    let whole = union(whole, tail(&q), 3.0);
    let whole = union(whole, bell(&q), 1.5);
    whole.max(-p.z) // flat soles
}

fn body(p: &Point) -> f64 {
    let barrel = ellipsoid(p, [-2.0, 0.0, 60.0], [54.0, 26.0, 24.0]);
    let chest = ellipsoid(p, [32.0, 0.0, 60.0], [23.0, 23.0, 25.0]);
    let rump = ellipsoid(p, [-38.0, 0.0, 62.0], [21.0, 24.0, 23.0]);
    union(union(barrel, chest, 10.0), rump, 10.0)
}

fn neck(p: &Point) -> f64 {
    let neck = limb(p, [36.0, 0.0, 68.0], [56.0, 0.0, 86.0], 18.0, 13.0);
    let dewlap = limb(p, [50.0, 0.0, 56.0], [58.0, 0.0, 72.0], 6.0, 5.0);
    union(neck, dewlap, 10.0)
}

fn head(p: &Point) -> f64 {
    // One side models both.
    let q = Point::new(p.x, p.y.abs(), p.z);
    let skull = ellipsoid(p, [62.0, 0.0, 92.0], [14.0, 14.0, 13.5]);
    let face = limb(p, [64.0, 0.0, 90.0], [79.0, 0.0, 79.0], 12.0, 9.5);
    let muzzle = ellipsoid(p, [81.0, 0.0, 77.5], [8.5, 12.0, 9.0]);
    let nostril = sphere(&q, [89.0, 5.2, 80.5], 1.8);
    let ear = leaf(&q);
    let horn = union(
        limb(&q, [58.0, 6.5, 101.0], [58.5, 12.5, 107.5], 4.6, 3.8),
        limb(&q, [58.5, 12.5, 107.5], [60.5, 14.0, 113.5], 3.8, 2.4),
        2.0,
    );
    let eye = sphere(&q, [70.2, 10.4, 94.0], 3.0);
    let shape = union(union(skull, face, 8.0), muzzle, 5.0);
    let shape = union(union(shape, ear, 4.0), horn, 2.5);
    let shape = union(shape, eye, 0.8);
    -union(-shape, nostril, 1.0)
}

/// An ear: a leaf that stands out sideways, tilted down and open to the front.
fn leaf(q: &Point) -> f64 {
    let tilt = Rotation3::from_euler_angles(-0.35, 0.0, -0.25);
    let local = Point::from(tilt.inverse() * (q - Point::new(57.0, 21.0, 95.0)));
    let blade = ellipsoid(&local, [0.0, 0.0, 0.0], [3.8, 11.5, 6.6]);
    let hollow = ellipsoid(&local, [5.2, 1.5, 0.3], [3.6, 8.0, 4.0]);
    -union(-blade, hollow, 1.5)
}

fn legs(p: &Point) -> f64 {
    let q = Point::new(p.x, p.y.abs(), p.z);
    let fore = union(
        limb(&q, [34.0, 15.0, 54.0], [34.5, 16.0, 26.0], 11.0, 8.6),
        limb(&q, [34.5, 16.0, 26.0], [35.0, 16.5, 0.0], 8.6, 8.2),
        3.0,
    );
    let hind = union(
        limb(&q, [-37.0, 14.0, 58.0], [-40.0, 16.5, 27.0], 13.0, 8.8),
        limb(&q, [-40.0, 16.5, 27.0], [-38.0, 16.5, 0.0], 8.8, 8.2),
        3.0,
    );
    let hooves =
        ellipsoid(&q, [36.0, 16.5, 2.0], [10.0, 9.6, 9.0]).min(ellipsoid(&q, [-37.0, 16.5, 2.0], [10.0, 9.6, 9.0]));
    union(fore.min(hind), hooves, 2.0)
}

fn udder(p: &Point) -> f64 {
    let q = Point::new((p.x + 18.0).abs(), p.y.abs(), p.z);
    let bag = ellipsoid(p, [-18.0, 0.0, 38.0], [12.0, 11.0, 10.0]);
    union(bag, limb(&q, [5.0, 4.8, 31.0], [5.4, 5.2, 26.5], 3.0, 2.5), 1.5)
}

fn tail(p: &Point) -> f64 {
    let root = limb(p, [-54.0, 0.0, 76.0], [-62.0, 1.0, 66.0], 4.2, 3.6);
    let rope = limb(p, [-62.0, 1.0, 66.0], [-65.5, 3.0, 44.0], 3.6, 3.2);
    let tuft = ellipsoid(p, [-66.0, 3.5, 36.0], [5.6, 5.6, 11.0]);
    union(union(root, rope, 4.0), tuft, 3.0)
}

/// Where the collar's bell hangs.
pub const BELL: [f64; 3] = [61.0, 1.0, 64.5];

fn bell(p: &Point) -> f64 {
    sphere(p, BELL, 5.6)
}
