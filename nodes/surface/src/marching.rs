//! The zero set inside one block, as triangles (marching cubes).

use crate::cases::{CASES, EDGES};
use crate::field::{Corners, look};
use crate::grid::{BlockKey, Grid};
use crate::quadric::Quadric;
use nalgebra::Vector3;

/// A grid edge of the world: the number of its lower corner along x, y, z, and the axis along which it runs.
pub type EdgeKey = ([i64; 3], u8);

/// A vertex on a grid edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// The edge that it was found on.
    pub edge: EdgeKey,
    /// Whether neighbouring blocks have the same vertex.
    pub shared: bool,
    /// On the surface, in the world, in metres.
    pub position: Vector3<f32>,
    /// Unit normal, outwards.
    pub normal: Vector3<f32>,
    /// One standard deviation along the normal, in metres.
    pub sigma_m: f32,
}

/// The surface inside one block.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Patch {
    /// Each grid edge at most once.
    pub vertices: Vec<Vertex>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A distance changes by at most one cell along an edge of one cell. More is no surface but the step between two sheets
/// that were both seen from the same side; the slack is for noise.
const STEEPEST: f32 = 1.6;
/// A vertex stands off the ends of its edge by this share of it, so that no triangle begins without an area.
const OFF_CORNER: f32 = 0.05;
/// Newton's step onto the surface is not followed farther than this, in cells.
const LONGEST_STEP: f32 = 0.5;

fn corner_of(cell: [usize; 3], corner: u8) -> [usize; 3] {
    [cell[0] + usize::from(corner & 1), cell[1] + usize::from(corner >> 1 & 1), cell[2] + usize::from(corner >> 2)]
}

/// Triangulates the cells of a block whose corners are all defined; `quadrics` are all that reach it.
pub fn march(grid: &Grid, key: BlockKey, corners: &Corners, quadrics: &[Quadric]) -> Patch {
    let along = corners.along;
    let index = |[x, y, z]: [usize; 3]| (x * along + y) * along + z;
    let mut patch = Patch::default();
    let mut vertex_on = vec![u32::MAX; 3 * corners.distances_m.len()];
    for cell in cells(grid.cells) {
        let distances = [0, 1, 2, 3, 4, 5, 6, 7u8].map(|c| corners.distances_m[index(corner_of(cell, c))]);
        let Some(inside) = inside(&distances, grid.cell_m()) else { continue };
        for triangle in &CASES[inside as usize] {
            patch.triangles.push(triangle.map(|edge| {
                let ends = EDGES[edge as usize];
                let place = corner_of(cell, ends[0]);
                let slot = &mut vertex_on[3 * index(place) + usize::from(edge / 4)];
                if *slot == u32::MAX {
                    *slot = patch.vertices.len() as u32;
                    let ends = ends.map(|corner| distances[corner as usize]);
                    patch.vertices.push(vertex(grid, key, place, edge / 4, ends, quadrics));
                }
                *slot
            }));
        }
    }
    patch
}

fn cells(along: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..along * along * along).map(move |n| [n / (along * along), n / along % along, n % along])
}

/// Which corners are inside; `None` when one is undefined, when the surface does not pass, or when the step between
/// two sheets does.
fn inside(distances: &[f32; 8], cell_m: f32) -> Option<u8> {
    if distances.iter().any(|d| d.is_nan()) {
        return None;
    }
    let inside = (0..8).filter(|&c| distances[c] < 0.0).map(|c| 1u8 << c).sum();
    let step = |&[a, b]: &[u8; 2]| {
        let (a, b) = (distances[a as usize], distances[b as usize]);
        (a < 0.0) != (b < 0.0) && (a - b).abs() > STEEPEST * cell_m
    };
    (inside != 0 && inside != u8::MAX && !EDGES.iter().any(step)).then_some(inside)
}

/// The vertex on one edge: between its ends by their distances, then one Newton step along the gradient.
fn vertex(grid: &Grid, key: BlockKey, place: [usize; 3], axis: u8, ends: [f32; 2], quadrics: &[Quadric]) -> Vertex {
    let share = (ends[0] / (ends[0] - ends[1])).clamp(OFF_CORNER, 1.0 - OFF_CORNER);
    let mut position = grid.corner(key, place);
    position[usize::from(axis)] += share * grid.cell_m();
    let number = [0, 1, 2].map(|axis| grid.corner_number(key, place, axis));
    let on_side = |axis: usize| place[axis] == 0 || place[axis] == grid.cells;
    let shared = (0..3).any(|other| other != usize::from(axis) && on_side(other));
    let Some(seen) = look(quadrics, &position) else {
        return Vertex { edge: (number, axis), shared, position, normal: Vector3::zeros(), sigma_m: 0.0 };
    };
    let longest = LONGEST_STEP * grid.cell_m();
    position -= seen.normal * seen.distance_m.clamp(-longest, longest);
    Vertex { edge: (number, axis), shared, position, normal: seen.normal, sigma_m: seen.sigma_m }
}
