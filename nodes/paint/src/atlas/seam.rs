//! Which texels show the same place on both sides of a seam, so that colour can spread from chart to chart.

use super::adjacency::NONE;
use super::build::{Projected, place_on};
use super::plane::Cell;
use super::{Atlas, NO_TEXEL, pack::Layout};
use geometry::TriangleMesh;
use rayon::prelude::*;

/// Pairs of texels in both orders, sorted, each once. A texel beside its chart shows a place on the chart's border; where
/// the surface goes on there, it is paired with the texel of the next chart at that place.
pub fn pairs(
    projected: &[Projected],
    layout: &Layout,
    atlas: &Atlas,
    mesh: &TriangleMesh,
    neighbours: &[[u32; 3]],
) -> Vec<[u32; 2]> {
    let mut chart_of = vec![NONE; mesh.triangles.len()];
    for (number, p) in projected.iter().enumerate() {
        for &t in &p.chart.triangles {
            chart_of[t as usize] = number as u32;
        }
    }
    let texel_at = |chart: u32, column: u32, row: u32| {
        let [left, top] = layout.corners[chart as usize];
        atlas.number_at[((top + row) * layout.width + left + column) as usize]
    };
    let other_side = |own: u32, cell: &Cell| {
        let across = across(cell, &neighbours[cell.triangle as usize])?;
        let chart = chart_of[across as usize];
        let plane = &projected[chart as usize].plane;
        let [column, row] = plane.texel(&place_on(mesh, cell)).map(|c| c.max(0.0) as u32).into();
        let found = chart != own && column < plane.size[0] && row < plane.size[1];
        found.then(|| texel_at(chart, column, row)).filter(|&number| number != NO_TEXEL)
    };
    let mut pairs: Vec<[u32; 2]> = projected
        .par_iter()
        .enumerate()
        .flat_map_iter(|(own, p)| {
            let beside = p.cells.iter().enumerate().filter(|(_, cell)| cell.is_used() && !cell.is_inside());
            beside.filter_map(move |(index, cell)| {
                let (column, row) = (index as u32 % p.plane.size[0], index as u32 / p.plane.size[0]);
                let own = own as u32;
                other_side(own, cell).map(|other| [texel_at(own, column, row), other])
            })
        })
        .flat_map_iter(|[a, b]| [[a, b], [b, a]])
        .collect();
    pairs.par_sort_unstable();
    pairs.dedup();
    pairs
}

/// The triangle across the edge on which the nearest place of a cell lies.
fn across(cell: &Cell, neighbours: &[u32; 3]) -> Option<u32> {
    // The edge (i, i + 1) lies where the weight of corner i + 2 is zero.
    (0..3).find(|i| cell.weights[(i + 2) % 3] == 0.0 && neighbours[*i] != NONE).map(|i| neighbours[i])
}
