//! Triangles around a solid: surface nets (Gibson 1998, "Constrained elastic surface nets"): one vertex for each sheet of
//! the surface in a cell (Nielson 2004, "Dual marching cubes": so that sheets do not touch), one quad around each grid
//! edge that it crosses; so the mesh is closed.

use super::sheets::{NONE, edge_at, sheets};
use geometry::TriangleMesh;
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Newton steps that bring a vertex onto the surface.
const PROJECTIONS: usize = 3;
/// Step of the numerical gradient, in cells.
const GRADIENT_STEP: f64 = 0.02;

/// Nodes along the side of a block.
const BLOCK: usize = 5;
/// A block whose middle is farther off than this many of its half diagonals is not looked into: more than 1, because the
/// distances are not exact.
const FAR: f64 = 2.5;

struct Grid {
    origin: Point3<f64>,
    cell: f64,
    nodes: [usize; 3],
}

impl Grid {
    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.nodes[1] + j) * self.nodes[0] + i
    }

    fn point(&self, [i, j, k]: [usize; 3]) -> Point3<f64> {
        self.origin + Vector3::new(i as f64, j as f64, k as f64) * self.cell
    }

    /// Every node but those of the last layers, which begin no cell.
    fn cells(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [x, y, z] = self.nodes.map(|n| n - 1);
        (0..z).flat_map(move |k| (0..y).flat_map(move |j| (0..x).map(move |i| [i, j, k])))
    }
}

/// The surface where `distance` is 0, with normals; the solid must lie inside the bounds. The result is in the units of
/// `distance`, the same on any number of threads.
pub fn surface_nets(
    distance: impl Fn(&Point3<f64>) -> f64 + Sync,
    [low, high]: [Point3<f64>; 2],
    cell: f64,
) -> TriangleMesh {
    let margin = Vector3::repeat(1.5 * cell);
    let steps = (high - low + 2.0 * margin) / cell;
    let grid = Grid { origin: low - margin, cell, nodes: [0, 1, 2].map(|axis| steps[axis].ceil() as usize + 1) };
    let values = sample(&distance, &grid);
    let (vertices, vertex_of_edge) = place_vertices(&grid, &values);
    let (vertices, normals) = onto_surface(&distance, vertices, cell);
    let triangles = connect(&grid, &values, &vertex_of_edge, &vertices);
    TriangleMesh { vertices, normals, triangles, ..TriangleMesh::default() }
}

/// The distance at each node; far from the surface that of the block's middle must do, since only its sign counts there.
fn sample(distance: &(impl Fn(&Point3<f64>) -> f64 + Sync), grid: &Grid) -> Vec<f64> {
    let blocks = grid.nodes.map(|n| n.div_ceil(BLOCK));
    let half_block = Vector3::repeat(0.5 * (BLOCK - 1) as f64 * grid.cell);
    let far = FAR * half_block.norm();
    let rows =
        |size: [usize; 3]| (0..size[2]).into_par_iter().flat_map_iter(move |k| (0..size[1]).map(move |j| (j, k)));
    let middle = |i, j, k| distance(&(grid.point([i * BLOCK, j * BLOCK, k * BLOCK]) + half_block));
    let coarse = rows(blocks).flat_map_iter(|(j, k)| (0..blocks[0]).map(move |i| middle(i, j, k)));
    let coarse: Vec<f64> = coarse.collect();
    let fine = rows(grid.nodes).flat_map_iter(|(j, k)| {
        let first = (k / BLOCK * blocks[1] + j / BLOCK) * blocks[0];
        let row = &coarse[first..first + blocks[0]];
        (0..grid.nodes[0]).map(move |i| match row[i / BLOCK] {
            about if about.abs() > far => about,
            _ => distance(&grid.point([i, j, k])),
        })
    });
    fine.collect()
}

/// For each sheet in each cell, the mean of the points where it crosses the cell's edges; and for each cell, the vertices
/// of its twelve edges.
fn place_vertices(grid: &Grid, values: &[f64]) -> (Vec<Point3<f64>>, BTreeMap<usize, [u32; 12]>) {
    let mut vertices = Vec::new();
    let mut vertex_of_edge = BTreeMap::new();
    for [i, j, k] in grid.cells() {
        let bits = |corner: usize| [corner & 1, corner >> 1 & 1, corner >> 2];
        let at = [0, 1, 2, 3, 4, 5, 6, 7].map(|corner| {
            let [x, y, z] = bits(corner);
            values[grid.index([i + x, j + y, k + z])]
        });
        let inside = at.map(|value| value < 0.0);
        if inside.iter().all(|side| *side == inside[0]) {
            continue;
        }
        let sheet_of_edge = sheets(&inside);
        let mut sums = [(Vector3::zeros(), 0.0); 4];
        for (corner, axis) in (0..8).flat_map(|corner| (0..3).map(move |axis| (corner, axis))) {
            let sheet = sheet_of_edge[edge_at(corner, axis)];
            if corner >> axis & 1 == 0 && sheet != NONE {
                let mut crossing = Vector3::from(bits(corner).map(|bit| bit as f64));
                crossing[axis] += at[corner] / (at[corner] - at[corner | 1 << axis]);
                sums[sheet].0 += crossing;
                sums[sheet].1 += 1.0;
            }
        }
        let first = vertices.len() as u32;
        let there = sums.iter().take_while(|(_, count)| *count > 0.0);
        vertices.extend(there.map(|(sum, count)| grid.point([i, j, k]) + sum * (grid.cell / count)));
        vertex_of_edge.insert(grid.index([i, j, k]), sheet_of_edge.map(|sheet| first.wrapping_add(sheet as u32)));
    }
    (vertices, vertex_of_edge)
}

/// Newton along the gradient, never farther than half a cell, so that neighbours keep their order.
fn onto_surface(
    distance: &(impl Fn(&Point3<f64>) -> f64 + Sync),
    vertices: Vec<Point3<f64>>,
    cell: f64,
) -> (Vec<Point3<f32>>, Vec<Vector3<f32>>) {
    let gradient = |p: &Point3<f64>| {
        let step = GRADIENT_STEP * cell;
        Vector3::from_fn(|axis, _| {
            let along = Vector3::ith(axis, step);
            (distance(&(p + along)) - distance(&(p - along))) / (2.0 * step)
        })
    };
    let projected = vertices.into_par_iter().map(|start| {
        let mut p = start;
        for _ in 0..PROJECTIONS {
            let slope = gradient(&p);
            p -= slope * (distance(&p) / slope.norm_squared().max(1e-6));
        }
        let way = p - start;
        p = start + way * (0.5 * cell / way.norm().max(0.5 * cell));
        (p.cast::<f32>(), gradient(&p).cast::<f32>().try_normalize(1e-9).unwrap_or_else(Vector3::z))
    });
    projected.collect::<Vec<_>>().into_iter().unzip()
}

/// A quad around each crossed edge, cut along its shorter diagonal.
fn connect(
    grid: &Grid,
    values: &[f64],
    vertex_of_edge: &BTreeMap<usize, [u32; 12]>,
    vertices: &[Point3<f32>],
) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for node in grid.cells() {
        let inside = values[grid.index(node)] < 0.0;
        for axis in 0..3 {
            let (side, other) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut next = node;
            next[axis] += 1;
            if inside == (values[grid.index(next)] < 0.0) || node[side] == 0 || node[other] == 0 {
                continue;
            }
            let vertex = |back: usize, down: usize| {
                let mut cell = node;
                cell[side] -= back;
                cell[other] -= down;
                let edge = edge_at(back << side | down << other, axis);
                vertex_of_edge.get(&grid.index(cell)).map_or(0, |vertices| vertices[edge])
            };
            let mut quad = [vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 1)];
            if !inside {
                quad.reverse();
            }
            let length = |a: u32, b: u32| (vertices[a as usize] - vertices[b as usize]).norm_squared();
            let [a, b, c, d] = quad;
            triangles.extend(if length(a, c) <= length(b, d) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            });
        }
    }
    triangles
}
