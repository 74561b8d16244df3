//! Cuts the surface into charts: nearly flat pieces that are projected straight down onto the texture.
//!
//! A chart grows from a seed over neighbouring triangles while their normals stay near the seed's. Nothing is solved, so
//! the density of cells is exact in the plane of the chart, and the stretch on the surface is bounded by the angle.

use super::adjacency::NONE;
use geometry::TriangleMesh;
use nalgebra::Vector3;

/// One nearly flat piece of the surface.
#[derive(Debug, Clone)]
pub struct Chart {
    /// Unit vector; the chart is seen against it.
    pub axis: Vector3<f32>,
    /// The triangles, each next to an earlier one where it can be.
    pub triangles: Vec<u32>,
}

/// A piece of less than this many cells is given to its neighbours where their axes allow.
const FRAGMENT_CELLS: f32 = 16.0;
/// Triangles of fragments may lean this far from the axis of the chart that takes them (cosine of 75 degrees).
const FRAGMENT_COSINE: f32 = 0.26;
const FRAGMENT_PASSES: usize = 8;

/// Cuts all triangles into charts, each triangle in exactly one; `limit_cosine` is that of the largest angle between a
/// triangle and its chart. Triangles of fragments and those without an area may exceed it.
pub fn cut(mesh: &TriangleMesh, neighbours: &[[u32; 3]], limit_cosine: f32, cell_m: f32) -> Vec<Chart> {
    let area_normals: Vec<Vector3<f32>> = (0..mesh.triangles.len()).map(|t| mesh.area_normal(t)).collect();
    let unit: Vec<Option<Vector3<f32>>> = area_normals.iter().map(|n| n.try_normalize(0.0)).collect();
    let mut chart_of = vec![NONE; mesh.triangles.len()];
    let mut charts: Vec<Chart> = Vec::new();
    for seed in 0..mesh.triangles.len() {
        if chart_of[seed] == NONE {
            let axis = seed_axis(mesh, seed, unit[seed], limit_cosine);
            let number = charts.len() as u32;
            let fits = |t: usize| unit[t].is_none_or(|n| n.dot(&axis) >= limit_cosine);
            charts.push(Chart { axis, triangles: grow(seed, number, neighbours, &mut chart_of, fits) });
        }
    }
    absorb_fragments(&mut charts, &mut chart_of, neighbours, &area_normals, &unit, cell_m);
    charts.retain(|chart| !chart.triangles.is_empty());
    charts
}

/// The mean normal of the seed's corners, which a single noisy triangle cannot tilt, unless the seed itself leans away.
fn seed_axis(mesh: &TriangleMesh, seed: usize, unit: Option<Vector3<f32>>, limit_cosine: f32) -> Vector3<f32> {
    let mean: Vector3<f32> = mesh.triangles[seed].iter().map(|&i| mesh.normals[i as usize]).sum();
    let own = unit.unwrap_or_else(Vector3::z);
    mean.try_normalize(1e-6).filter(|mean| mean.dot(&own) >= limit_cosine).unwrap_or(own)
}

/// All unassigned triangles that hang together with the seed and fit, nearest first.
fn grow(
    seed: usize,
    number: u32,
    neighbours: &[[u32; 3]],
    chart_of: &mut [u32],
    fits: impl Fn(usize) -> bool,
) -> Vec<u32> {
    chart_of[seed] = number;
    let mut found = vec![seed as u32];
    let mut at = 0;
    while at < found.len() {
        for next in neighbours[found[at] as usize].into_iter().filter(|&t| t != NONE) {
            if chart_of[next as usize] == NONE && fits(next as usize) {
                chart_of[next as usize] = number;
                found.push(next);
            }
        }
        at += 1;
    }
    found
}

/// Gives the triangles of fragments one by one to the adjacent whole chart that they lean least from.
fn absorb_fragments(
    charts: &mut [Chart],
    chart_of: &mut [u32],
    neighbours: &[[u32; 3]],
    area_normals: &[Vector3<f32>],
    unit: &[Option<Vector3<f32>>],
    cell_m: f32,
) {
    let cells = |chart: &Chart| {
        chart.triangles.iter().map(|&t| 0.5 * area_normals[t as usize].norm()).sum::<f32>() / (cell_m * cell_m)
    };
    let whole: Vec<bool> = charts.iter().map(|chart| cells(chart) >= FRAGMENT_CELLS).collect();
    let mut loose: Vec<u32> =
        charts.iter().zip(&whole).filter(|(_, whole)| !**whole).flat_map(|(c, _)| c.triangles.clone()).collect();
    for _ in 0..FRAGMENT_PASSES {
        let before = loose.len();
        loose.retain(|&t| {
            let lean = |chart: u32| unit[t as usize].map_or(1.0, |n| n.dot(&charts[chart as usize].axis));
            let best = neighbours[t as usize]
                .into_iter()
                .filter(|&next| next != NONE)
                .map(|next| chart_of[next as usize])
                .filter(|&chart| whole[chart as usize] && lean(chart) >= FRAGMENT_COSINE)
                .max_by(|&a, &b| lean(a).total_cmp(&lean(b)));
            if let Some(chart) = best {
                chart_of[t as usize] = chart;
                charts[chart as usize].triangles.push(t);
            }
            best.is_none()
        });
        if loose.len() == before {
            break;
        }
    }
    for (number, chart) in charts.iter_mut().enumerate().filter(|(number, _)| !whole[*number]) {
        chart.triangles.retain(|&t| chart_of[t as usize] == number as u32);
    }
}

/// Charts of those of the `loose` triangles (sorted) that hang together, with the same axis.
pub fn pieces(axis: Vector3<f32>, loose: &[u32], neighbours: &[[u32; 3]]) -> Vec<Chart> {
    let mut taken = vec![false; loose.len()];
    let mut pieces = Vec::new();
    for seed in 0..loose.len() {
        if taken[seed] {
            continue;
        }
        taken[seed] = true;
        let mut found = vec![loose[seed]];
        let mut at = 0;
        while at < found.len() {
            for next in neighbours[found[at] as usize] {
                if let Ok(i) = loose.binary_search(&next)
                    && !taken[i]
                {
                    taken[i] = true;
                    found.push(next);
                }
            }
            at += 1;
        }
        pieces.push(Chart { axis, triangles: found });
    }
    pieces
}
