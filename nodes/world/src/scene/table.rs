//! The table: a plane of little squares with the grain of wood, of low contrast.

use super::file::TableSection;
use super::{Surface, Texture};
use crate::random::lattice;
use geometry::{METRES_PER_MM, TriangleMesh};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

/// Edge of a texture cell.
const TEXEL_MM: f64 = 0.5;
/// Edge of a square of the mesh: short enough that no triangle reaches behind the camera.
const SQUARE_MM: f64 = 20.0;
const GRAIN_SEED: u64 = 0x7ab1e;

/// The table's top at z = 0, around the origin.
pub fn table(section: &TableSection) -> Surface {
    let [width, depth] = section.size_mm;
    Surface {
        name: "table".to_owned(),
        mesh: top(width, depth),
        texture: Some(wood(section)),
        specular: 0.02,
        shininess: 8.0,
    }
}

fn top(width_mm: f64, depth_mm: f64) -> TriangleMesh {
    let count = |length: f64| (length / SQUARE_MM).ceil().max(1.0) as u32;
    let (columns, rows) = (count(width_mm), count(depth_mm));
    let mut mesh = TriangleMesh::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let (u, v) = (f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
            let p = Point3::new((u - 0.5) * width_mm, (0.5 - v) * depth_mm, 0.0) * METRES_PER_MM;
            mesh.vertices.push(p.cast());
            mesh.normals.push(Vector3::z());
            mesh.uv.push([u as f32, v as f32]);
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let a = row * (columns + 1) + column;
            let (b, c, d) = (a + 1, a + columns + 1, a + columns + 2);
            mesh.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    mesh
}

/// Long grain along x: smooth noise, drawn out, folded into rings.
fn wood(section: &TableSection) -> Texture {
    let [width, height] = section.size_mm.map(|length| (length / TEXEL_MM).ceil().max(1.0) as usize);
    let texel = &|row: usize, column: usize| {
        let (x, y) = (column as f64 * TEXEL_MM, row as f64 * TEXEL_MM);
        let bend = lattice(GRAIN_SEED, [x / 90.0, y / 25.0, 0.0]);
        let ring = (0.35 * y + 9.0 * bend).sin();
        let fibre = lattice(GRAIN_SEED + 1, [x / 14.0, y / 0.9, 0.0]);
        let shade = f64::from(section.grain) * (0.6 * ring + 0.4 * fibre);
        section.colour.map(|c| (f64::from(c) + shade).round().clamp(0.0, 255.0) as u8)
    };
    let rows = (0..height).into_par_iter();
    let rgb = rows.flat_map_iter(|row| (0..width).map(move |column| texel(row, column))).collect();
    Texture { width, height, rgb }
}
