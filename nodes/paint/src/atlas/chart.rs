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

/// A piece smaller than this many cells, or this share of the surface, is a fragment: its triangles go to its neighbours.
const FRAGMENT_CELLS: f32 = 16.0;
const FRAGMENT_SHARE: f32 = 1.0 / 2000.0;
/// A triangle smaller than this many cells, or this share of the surface, is grain of a rough surface: the mean normal of
/// its corners says which way the surface faces there.
const GRAIN_CELLS: f32 = 4.0;
const GRAIN_SHARE: f32 = 1.0 / 10_000.0;
/// Grain and fragments may lean this far from the axis of their chart (cosine of 75 degrees).
const ROUGH_COSINE: f32 = 0.26;
const FRAGMENT_PASSES: usize = 8;

/// What is asked of each triangle.
struct Facets {
    area_m2: Vec<f32>,
    /// Unit normal; none without an area.
    normal: Vec<Option<Vector3<f32>>>,
    /// Mean normal of the corners.
    smooth: Vec<Vector3<f32>>,
    total_m2: f32,
    cell_m2: f32,
}

impl Facets {
    fn of(mesh: &TriangleMesh, cell_m: f32) -> Self {
        let area_normal: Vec<Vector3<f32>> = (0..mesh.triangles.len()).map(|t| mesh.area_normal(t)).collect();
        let corners = |t: &[u32; 3]| t.iter().map(|&i| mesh.normals[i as usize]).sum::<Vector3<f32>>();
        Self {
            area_m2: area_normal.iter().map(|n| 0.5 * n.norm()).collect(),
            normal: area_normal.iter().map(|n| n.try_normalize(0.0)).collect(),
            smooth: mesh.triangles.iter().map(|t| corners(t).try_normalize(1e-6).unwrap_or_default()).collect(),
            total_m2: mesh.area() as f32,
            cell_m2: cell_m * cell_m,
        }
    }

    /// Smaller than so many cells, or than a share of the surface.
    fn is_small(&self, area_m2: f32, cells: f32, share: f32) -> bool {
        area_m2 < (cells * self.cell_m2).max(share * self.total_m2)
    }

    /// Cosine of the angle to an axis; a triangle without an area fits any.
    fn lean(&self, t: usize, axis: &Vector3<f32>) -> f32 {
        self.normal[t].map_or(1.0, |n| n.dot(axis))
    }

    fn fits(&self, t: usize, axis: &Vector3<f32>, limit_cosine: f32) -> bool {
        self.lean(t, axis) >= limit_cosine
            || (self.lean(t, axis) >= ROUGH_COSINE
                && self.smooth[t].dot(axis) >= limit_cosine
                && self.is_small(self.area_m2[t], GRAIN_CELLS, GRAIN_SHARE))
    }

    /// The axis of a chart that grows from here.
    fn seed_axis(&self, t: usize, limit_cosine: f32) -> Vector3<f32> {
        let own = self.normal[t].unwrap_or_else(Vector3::z);
        // A single noisy triangle should not tilt its chart; one on an edge should not be tilted by its corners.
        if self.smooth[t].dot(&own) >= limit_cosine { self.smooth[t] } else { own }
    }
}

/// Cuts all triangles into charts, each triangle in exactly one; `limit_cosine` is that of the largest angle between a
/// triangle and its chart. Grain, fragments and triangles without an area may exceed it.
pub fn cut(mesh: &TriangleMesh, neighbours: &[[u32; 3]], limit_cosine: f32, cell_m: f32) -> Vec<Chart> {
    let facets = Facets::of(mesh, cell_m);
    let mut chart_of = vec![NONE; mesh.triangles.len()];
    let mut charts: Vec<Chart> = Vec::new();
    for seed in 0..mesh.triangles.len() {
        if chart_of[seed] == NONE {
            let axis = facets.seed_axis(seed, limit_cosine);
            let fits = |t: usize| facets.fits(t, &axis, limit_cosine);
            let triangles = grow(seed, charts.len() as u32, neighbours, &mut chart_of, fits);
            charts.push(Chart { axis, triangles });
        }
    }
    absorb_fragments(&mut charts, &mut chart_of, neighbours, &facets);
    charts.retain(|chart| !chart.triangles.is_empty());
    charts
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
fn absorb_fragments(charts: &mut [Chart], chart_of: &mut [u32], neighbours: &[[u32; 3]], facets: &Facets) {
    let area = |chart: &Chart| chart.triangles.iter().map(|&t| facets.area_m2[t as usize]).sum::<f32>();
    let whole: Vec<bool> =
        charts.iter().map(|chart| !facets.is_small(area(chart), FRAGMENT_CELLS, FRAGMENT_SHARE)).collect();
    let mut loose: Vec<u32> =
        charts.iter().zip(&whole).filter(|(_, whole)| !**whole).flat_map(|(c, _)| c.triangles.clone()).collect();
    for _ in 0..FRAGMENT_PASSES {
        let before = loose.len();
        loose.retain(|&t| {
            let lean = |chart: u32| facets.lean(t as usize, &charts[chart as usize].axis);
            let best = neighbours[t as usize]
                .into_iter()
                .filter(|&next| next != NONE)
                .map(|next| chart_of[next as usize])
                .filter(|&chart| whole[chart as usize] && lean(chart) >= ROUGH_COSINE)
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
