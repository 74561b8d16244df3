//! Triangles around a solid: surface nets (Gibson 1998, "Constrained elastic surface nets"): one vertex in each cell that
//! the surface crosses, one quad around each grid edge that it crosses; so the mesh is closed.

use geometry::TriangleMesh;
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

/// Newton steps that bring a vertex onto the surface.
const PROJECTIONS: usize = 3;
/// Step of the numerical gradient, in cells.
const GRADIENT_STEP: f64 = 0.02;

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
    let (vertices, vertex_of_cell) = place_vertices(&grid, &values);
    let (vertices, normals) = onto_surface(&distance, vertices, cell);
    let triangles = connect(&grid, &values, &vertex_of_cell, &vertices);
    TriangleMesh { vertices, normals, triangles, ..TriangleMesh::default() }
}

fn sample(distance: &(impl Fn(&Point3<f64>) -> f64 + Sync), grid: &Grid) -> Vec<f64> {
    let [width, depth, height] = grid.nodes;
    let rows = (0..height).into_par_iter().flat_map_iter(|k| (0..depth).map(move |j| (j, k)));
    let rows: Vec<Vec<f64>> =
        rows.map(|(j, k)| (0..width).map(|i| distance(&grid.point([i, j, k]))).collect()).collect();
    rows.concat()
}

/// The mean of the points where the surface crosses the cell's edges.
fn place_vertices(grid: &Grid, values: &[f64]) -> (Vec<Point3<f64>>, Vec<u32>) {
    const CORNERS: [[usize; 3]; 8] =
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];
    let mut vertices = Vec::new();
    let mut vertex_of_cell = vec![u32::MAX; values.len()];
    for [i, j, k] in grid.cells() {
        let corner = |c: usize| CORNERS[c].map(|x| x as f64);
        let at = CORNERS.map(|[a, b, c]| values[grid.index([i + a, j + b, k + c])]);
        let mut sum = Vector3::zeros();
        let mut crossings = 0.0;
        for a in 0..8 {
            for b in [1, 2, 4].iter().map(|bit| a | bit).filter(|&b| b != a) {
                if (at[a] < 0.0) != (at[b] < 0.0) {
                    let t = at[a] / (at[a] - at[b]);
                    sum += Vector3::from(corner(a)) * (1.0 - t) + Vector3::from(corner(b)) * t;
                    crossings += 1.0;
                }
            }
        }
        if crossings > 0.0 {
            vertex_of_cell[grid.index([i, j, k])] = vertices.len() as u32;
            vertices.push(grid.point([i, j, k]) + sum * (grid.cell / crossings));
        }
    }
    (vertices, vertex_of_cell)
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
fn connect(grid: &Grid, values: &[f64], vertex_of_cell: &[u32], vertices: &[Point3<f32>]) -> Vec<[u32; 3]> {
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
            let cell = |back: usize, down: usize| {
                let mut cell = node;
                cell[side] -= back;
                cell[other] -= down;
                vertex_of_cell[grid.index(cell)]
            };
            let mut quad = [cell(0, 0), cell(1, 0), cell(1, 1), cell(0, 1)];
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
