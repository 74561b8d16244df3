//! Paint with crisp edges: a mesh is cut along the edges of the paint, so that each triangle has one colour.

use geometry::TriangleMesh;
use nalgebra::{Point3, Vector3};
use std::collections::BTreeMap;

/// Where a paint is: negative inside, in any unit, at a point of the model in millimetres.
pub type Zone = Box<dyn Fn(&Point3<f64>) -> f64 + Sync>;

/// Zones of colour (sRGB); where they overlap the first wins.
pub struct Coat {
    pub zones: Vec<(Zone, [u8; 3])>,
    /// Where there is no zone.
    pub ground: [u8; 3],
}

impl Coat {
    fn colour(&self, p: &Point3<f64>) -> [u8; 3] {
        self.zones.iter().find(|(zone, _)| zone(p) < 0.0).map_or(self.ground, |(_, colour)| *colour)
    }
}

/// The cut stays this far from the ends of an edge (as a share of it), so that no triangle becomes a sliver.
const CUT_MARGIN: f64 = 0.12;
const BISECTIONS: usize = 12;

/// Cuts the mesh along the edges of the paint and colours it. A vertex on an edge of the paint comes once for each
/// colour, at the very same position and with the same normal.
pub fn paint(mut mesh: TriangleMesh, coat: &Coat) -> TriangleMesh {
    for (zone, _) in &coat.zones {
        cut(&mut mesh, zone);
    }
    let mut painted = TriangleMesh::default();
    let mut vertex_of: BTreeMap<(u32, [u8; 3]), u32> = BTreeMap::new();
    for t in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(t).map(|p| p.cast::<f64>());
        let colour = coat.colour(&Point3::from((a.coords + b.coords + c.coords) / 3.0));
        painted.triangles.push(mesh.triangles[t].map(|i| {
            *vertex_of.entry((i, colour)).or_insert_with(|| {
                painted.vertices.push(mesh.vertices[i as usize]);
                painted.normals.push(mesh.normals[i as usize]);
                painted.colours.push(colour);
                painted.vertices.len() as u32 - 1
            })
        }));
    }
    painted
}

/// Splits each triangle that the zone's edge crosses.
fn cut(mesh: &mut TriangleMesh, zone: &Zone) {
    let inside: Vec<bool> = mesh.vertices.iter().map(|p| zone(&p.cast()) < 0.0).collect();
    let mut cuts: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    for triangle in std::mem::take(&mut mesh.triangles) {
        let sides = triangle.map(|i| inside[i as usize]);
        // The corner that lies alone on its side of the edge, if there is one.
        let Some(alone) = (0..3).find(|&i| sides[i] != sides[(i + 1) % 3] && sides[i] != sides[(i + 2) % 3]) else {
            triangles.push(triangle);
            continue;
        };
        let [a, b, c] = [0, 1, 2].map(|step| triangle[(alone + step) % 3]);
        let mut cut_at = |from: u32, to: u32| {
            let edge = [from.min(to), from.max(to)];
            *cuts.entry(edge).or_insert_with(|| cut_edge(mesh, zone, edge))
        };
        let (ab, ac) = (cut_at(a, b), cut_at(a, c));
        triangles.extend([[a, ab, ac], [ab, b, c], [ab, c, ac]]);
    }
    mesh.triangles = triangles;
}

fn cut_edge(mesh: &mut TriangleMesh, zone: &Zone, [a, b]: [u32; 2]) -> u32 {
    let (from, to) = (mesh.vertices[a as usize].cast::<f64>(), mesh.vertices[b as usize].cast::<f64>());
    let from_inside = zone(&from) < 0.0;
    let [mut low, mut high] = [0.0, 1.0];
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if (zone(&from.coords.lerp(&to.coords, middle).into()) < 0.0) == from_inside {
            low = middle
        } else {
            high = middle
        }
    }
    let at = low.clamp(CUT_MARGIN, 1.0 - CUT_MARGIN);
    let normal = mesh.normals[a as usize].lerp(&mesh.normals[b as usize], at as f32);
    mesh.vertices.push(Point3::from(from.coords.lerp(&to.coords, at)).cast());
    mesh.normals.push(normal.try_normalize(1e-9).unwrap_or_else(Vector3::z));
    mesh.vertices.len() as u32 - 1
}
