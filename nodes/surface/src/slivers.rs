//! Edges too short for their grid are collapsed: marching cubes leave slivers wherever the surface passes close to a corner.
//!
//! An edge goes only if the surface stays a surface (the link condition of Dey et al. 1999: its two ends have no neighbours in
//! common but the two opposite it) and no triangle turns over or becomes a needle. Rims are left as they are.

use crate::sheet::Sheet;
use crate::stars::Stars;
use nalgebra::Vector3;

/// Edges shorter than this share of a cell are collapsed.
const SHORTEST_CELLS: f32 = 0.3;
/// No triangle may stand at more than 60 degrees to the surface.
const LEAST_COSINE: f32 = 0.5;
/// Edges that a collapse lengthens stay below this, in cells.
const LONGEST_CELLS: f32 = 1.8;
/// A collapse brings new short edges together; after so many rounds hardly any is left.
const ROUNDS: usize = 3;

/// Collapses the short edges, the shortest first.
pub fn collapse(sheet: &mut Sheet, cell_m: f32) {
    for _ in 0..ROUNDS {
        let mut stars = Stars::new(sheet);
        let mut collapsed = 0;
        let mut gone = vec![false; sheet.triangles.len()];
        for (_, keep, drop) in short_edges(sheet, SHORTEST_CELLS * cell_m) {
            if may_collapse(sheet, &stars, [keep, drop], cell_m) {
                merge(sheet, &mut stars, [keep, drop], &mut gone);
                collapsed += 1;
            }
        }
        let mut gone = gone.iter();
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

fn middle(sheet: &Sheet, [a, b]: [u32; 2]) -> Vector3<f32> {
    (sheet.positions[a as usize] + sheet.positions[b as usize]) * 0.5
}

fn may_collapse(sheet: &Sheet, stars: &Stars, [keep, drop]: [u32; 2], cell_m: f32) -> bool {
    if stars.on_rim(keep) || stars.on_rim(drop) {
        return false;
    }
    let at_drop = stars.ring(sheet, drop);
    let common = stars.ring(sheet, keep).iter().filter(|v| at_drop.binary_search(v).is_ok()).count();
    let still_an_edge = at_drop.binary_search(&keep).is_ok();
    still_an_edge && common == 2 && keeps_shape(sheet, stars, [keep, drop], cell_m)
}

/// Moves `keep` to the middle of the edge, and gives it the triangles of `drop`.
fn merge(sheet: &mut Sheet, stars: &mut Stars, [keep, drop]: [u32; 2], gone: &mut [bool]) {
    let (k, d) = (keep as usize, drop as usize);
    sheet.positions[k] = middle(sheet, [keep, drop]);
    sheet.normals[k] = (sheet.normals[k] + sheet.normals[d]).try_normalize(0.0).unwrap_or(sheet.normals[k]);
    sheet.sigmas_m[k] = sheet.sigmas_m[k].max(sheet.sigmas_m[d]);
    for t in stars.take(drop) {
        let triangle = sheet.triangles[t as usize];
        if triangle.contains(&keep) {
            gone[t as usize] = true;
            triangle.into_iter().for_each(|v| stars.remove(v, t));
        } else {
            sheet.triangles[t as usize] = triangle.map(|v| if v == drop { keep } else { v });
            stars.insert(keep, t);
        }
    }
}

fn keeps_shape(sheet: &Sheet, stars: &Stars, [keep, drop]: [u32; 2], cell_m: f32) -> bool {
    let middle = middle(sheet, [keep, drop]);
    let longest_squared = (LONGEST_CELLS * cell_m).powi(2);
    let star = [keep, drop].into_iter().flat_map(|v| stars.of(v));
    star.map(|&t| sheet.triangles[t as usize]).filter(|t| !(t.contains(&keep) && t.contains(&drop))).all(|triangle| {
        let outwards = sheet.outwards(triangle);
        let [a, b, c] = triangle.map(|v| if v == keep || v == drop { middle } else { sheet.positions[v as usize] });
        let after = (b - a).cross(&(c - a));
        let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        after.dot(&outwards) > LEAST_COSINE * after.norm() * outwards.norm() && longest < longest_squared
    })
}
