//! Plain things for a cluttered table: rounded solids that stand on z = 0, painted in two colours.

use super::solid::{Point, cylinder, ellipsoid, limb, rounded_box, sphere, union, upright_ring, without};
use super::{Coat, paint, surface_nets};
use geometry::TriangleMesh;
use serde::Deserialize;

/// What it is. Sizes are along x, y and z, in millimetres.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Primitive {
    /// Rounded by 2 mm along its edges.
    Box,
    /// An ellipsoid when the sides differ.
    Sphere,
    /// Upright; the rim is rounded by 2 mm.
    Cylinder,
    /// Upright, round, a little blunt at the top.
    Cone,
    /// A hollow cylinder with a handle along x.
    Mug,
    /// A bowling pin or a vase: belly, neck and head.
    Skittle,
}

/// Where the second colour goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pattern {
    /// Nowhere.
    #[default]
    Plain,
    /// Rings across z.
    Rings,
    /// Stripes across x.
    Stripes,
    /// Cubes of both colours in turn.
    Checks,
    /// Balls on a grid.
    Spots,
}

/// Rounding of edges.
const EDGE_MM: f64 = 2.0;
/// Wall of a mug.
const WALL_MM: f64 = 4.5;
/// A cell is this share of the longest side, within limits.
const CELL_SHARE: f64 = 0.018;
const CELL_LIMITS_MM: [f64; 2] = [1.2, 4.0];

/// The thing with sides of the given lengths, in millimetres.
pub fn primitive(
    kind: Primitive,
    sides_mm: [f64; 3],
    pattern: Pattern,
    pattern_mm: f64,
    colours: [[u8; 3]; 2],
) -> TriangleMesh {
    let [x, y, z] = sides_mm;
    let bounds = [Point::new(-0.5 * x, -0.5 * y, 0.0), Point::new(0.5 * x, 0.5 * y, z)];
    let cell = (CELL_SHARE * x.max(y).max(z)).clamp(CELL_LIMITS_MM[0], CELL_LIMITS_MM[1]);
    let mesh = surface_nets(|p| distance(kind, sides_mm, p), bounds, cell);
    let zones = match pattern {
        Pattern::Plain => Vec::new(),
        _ => vec![(Box::new(move |p: &Point| level(pattern, pattern_mm, p)) as super::coat::Zone, colours[1])],
    };
    paint(mesh, &Coat { zones, ground: colours[0] })
}

fn distance(kind: Primitive, [x, y, z]: [f64; 3], p: &Point) -> f64 {
    let half = [0.5 * x, 0.5 * y, 0.5 * z];
    let middle = [0.0, 0.0, half[2]];
    let radius = half[0].min(half[1]);
    match kind {
        Primitive::Box => rounded_box(p, middle, half, EDGE_MM),
        Primitive::Sphere => ellipsoid(p, middle, half),
        Primitive::Cylinder => cylinder(p, radius, [0.0, z], EDGE_MM),
        Primitive::Cone => cone(p, radius, z),
        Primitive::Mug => mug(p, x, radius, z),
        Primitive::Skittle => {
            let belly = ellipsoid(p, [0.0, 0.0, 0.28 * z], [half[0], half[1], 0.36 * z]);
            let neck = limb(p, [0.0, 0.0, 0.4 * z], [0.0, 0.0, 0.8 * z], 0.6 * radius, 0.35 * radius);
            let head = sphere(p, [0.0, 0.0, z - 0.5 * radius], 0.5 * radius);
            union(union(belly, neck, 0.5 * radius), head, 0.3 * radius).max(-p.z)
        }
    }
}

/// The radius goes from the foot to a quarter of it at the top.
fn cone(p: &Point, radius: f64, height: f64) -> f64 {
    let slope = 0.75 * radius / height;
    let flank = (p.coords.xy().norm() - radius + slope * p.z) / slope.hypot(1.0);
    let ends = (p.z - 0.5 * height).abs() - 0.5 * height;
    without(flank, -ends, EDGE_MM)
}

/// The cup stands at one end of the length so that the handle fits in.
fn mug(p: &Point, length: f64, radius: f64, height: f64) -> f64 {
    let cup_at = radius - 0.5 * length;
    let q = Point::new(p.x - cup_at, p.y, p.z);
    let thickness = 0.8 * WALL_MM;
    let reach = 0.5 * (length - 2.0 * radius).max(4.0 * WALL_MM);
    let ring = upright_ring(&q, [radius, 0.0, 0.52 * height], 2.0 * reach - thickness, thickness);
    let outside = union(cylinder(&q, radius, [0.0, height], EDGE_MM), ring, 3.0);
    without(outside, cylinder(&q, radius - WALL_MM, [WALL_MM, 2.0 * height], 3.0 * EDGE_MM), EDGE_MM)
}

/// Negative where the second colour is.
fn level(pattern: Pattern, size_mm: f64, p: &Point) -> f64 {
    // Shifted, so that an edge of the pattern does not fall on the foot.
    let wave = |x: f64| (std::f64::consts::PI * (x / size_mm + 0.31)).sin();
    match pattern {
        Pattern::Plain => 1.0,
        Pattern::Rings => wave(p.z),
        Pattern::Stripes => wave(p.x),
        Pattern::Checks => wave(p.x) * wave(p.y) * wave(p.z),
        Pattern::Spots => 1.6 - wave(p.x).abs() - wave(p.y).abs() - wave(p.z).abs() + 0.55,
    }
}
