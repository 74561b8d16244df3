//! Edges too short for their grid are collapsed: marching cubes leave slivers wherever the surface passes close to a corner.
//!
//! An edge goes only if the surface stays a surface (the link condition of Dey et al. 1999: its two ends have no neighbours in
//! common but the two opposite it) and no triangle turns over or becomes a needle. Rims are left as they are.

use crate::sheet::Sheet;
use crate::topology::{half_edges, runs};

/// Edges shorter than this share of a cell are collapsed.
const SHORTEST_CELLS: f32 = 0.3;
/// No triangle may turn by more than 60 degrees.
const LEAST_COSINE: f32 = 0.5;
/// Edges that a collapse lengthens stay below this, in cells.
const LONGEST_CELLS: f32 = 1.8;
/// A collapse brings new short edges together; after so many rounds hardly any is left.
const ROUNDS: usize = 3;

/// The triangles at each vertex, kept while edges collapse.
struct Stars {
    of_vertex: Vec<Vec<u32>>,
    on_rim: Vec<bool>,
    gone: Vec<bool>,
}

impl Stars {
    fn new(sheet: &Sheet) -> Self {
        let mut of_vertex = vec![Vec::new(); sheet.positions.len()];
        for (t, triangle) in (0u32..).zip(&sheet.triangles) {
            for &v in triangle {
                of_vertex[v as usize].push(t);
            }
        }
        let mut on_rim = vec![false; sheet.positions.len()];
        for run in runs(&half_edges(&sheet.triangles)) {
            if run.len() != 2 {
                on_rim[run[0].0 as usize] = true;
                on_rim[run[0].1 as usize] = true;
            }
        }
        Self { of_vertex, on_rim, gone: vec![false; sheet.triangles.len()] }
    }

    fn ring(&self, sheet: &Sheet, v: u32) -> Vec<u32> {
        let star = self.of_vertex[v as usize].iter();
        let mut ring: Vec<u32> = star.flat_map(|&t| sheet.triangles[t as usize]).filter(|&w| w != v).collect();
        ring.sort_unstable();
        ring.dedup();
        ring
    }
}

/// Collapses the short edges, the shortest first.
pub fn collapse(sheet: &mut Sheet, cell_m: f32) {
    for _ in 0..ROUNDS {
        let mut stars = Stars::new(sheet);
        let mut collapsed = 0;
        for (_, keep, drop) in short_edges(sheet, SHORTEST_CELLS * cell_m) {
            collapsed += usize::from(try_collapse(sheet, &mut stars, keep, drop, cell_m));
        }
        let mut gone = stars.gone.iter();
        sheet.triangles.retain(|_| !gone.next().is_some_and(|&gone| gone));
        if collapsed == 0 {
            break;
        }
    }
}

fn short_edges(sheet: &Sheet, shortest_m: f32) -> Vec<(f32, u32, u32)> {
    let mut short = Vec::new();
    for &[a, b, c] in &sheet.triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            let length = (sheet.positions[a as usize] - sheet.positions[b as usize]).norm();
            // Each inner edge is met from both sides; once is enough.
            if a < b && length < shortest_m {
                short.push((length, a, b));
            }
        }
    }
    short.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    short
}

/// Moves `keep` to the middle of the edge and takes `drop` away, if nothing speaks against it.
fn try_collapse(sheet: &mut Sheet, stars: &mut Stars, keep: u32, drop: u32, cell_m: f32) -> bool {
    let (k, d) = (keep as usize, drop as usize);
    if stars.on_rim[k] || stars.on_rim[d] {
        return false;
    }
    let at_drop = stars.ring(sheet, drop);
    let Ok(_) = at_drop.binary_search(&keep) else { return false };
    let common = stars.ring(sheet, keep).iter().filter(|v| at_drop.binary_search(v).is_ok()).count();
    let middle = (sheet.positions[k] + sheet.positions[d]) * 0.5;
    // With three triangles at a vertex opposite, the collapse would fold two of them onto each other.
    if common != 2 || !keeps_shape(sheet, stars, [keep, drop], middle, cell_m) {
        return false;
    }
    sheet.positions[k] = middle;
    sheet.normals[k] = (sheet.normals[k] + sheet.normals[d]).try_normalize(0.0).unwrap_or(sheet.normals[k]);
    sheet.sigmas_m[k] = sheet.sigmas_m[k].max(sheet.sigmas_m[d]);
    for t in std::mem::take(&mut stars.of_vertex[d]) {
        let triangle = sheet.triangles[t as usize];
        if triangle.contains(&keep) {
            stars.gone[t as usize] = true;
            for v in triangle {
                stars.of_vertex[v as usize].retain(|&other| other != t);
            }
        } else {
            sheet.triangles[t as usize] = triangle.map(|v| if v == drop { keep } else { v });
            stars.of_vertex[k].push(t);
        }
    }
    true
}

fn keeps_shape(sheet: &Sheet, stars: &Stars, [keep, drop]: [u32; 2], middle: nalgebra::Vector3<f32>, cell_m: f32) -> bool {
    let longest_squared = (LONGEST_CELLS * cell_m).powi(2);
    let star = [keep, drop].into_iter().flat_map(|v| &stars.of_vertex[v as usize]);
    star.map(|&t| sheet.triangles[t as usize]).filter(|t| !(t.contains(&keep) && t.contains(&drop))).all(|triangle| {
        let before = sheet.area_normal(triangle);
        let [a, b, c] = triangle.map(|v| if v == keep || v == drop { middle } else { sheet.positions[v as usize] });
        let after = (b - a).cross(&(c - a));
        let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        after.dot(&before) > LEAST_COSINE * after.norm() * before.norm() && longest < longest_squared
    })
}
