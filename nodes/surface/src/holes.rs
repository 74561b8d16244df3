//! Holes in the final mesh: found as rims, closed by caps.

use crate::cap::{Cap, Edges, edge, length_m};
use crate::grid::KeyHash;
use crate::ground::Ground;
use crate::sheet::Sheet;
use crate::topology::{area_m2, rims};
use rayon::prelude::*;
use std::collections::HashSet;
use std::f64::consts::PI;

/// A cap larger than this share of what was measured would make more of a guess than of a model.
const LARGEST: f32 = 1.0 / 3.0;

/// Fills every hole whose rim is at most pi times `largest_m` long.
pub fn fill(sheet: &mut Sheet, largest_m: f64, ground: Option<&Ground>) {
    sew(sheet, over_all(sheet, PI * largest_m), ground);
}

/// Closes every hole that is left, whatever its size, but those over which the cap would be larger than a third of all that
/// was measured: a wall, or a thing of which one side was seen. A thing that stands on the table with all of such a rim is
/// closed all the same. Returns how many were left open.
pub fn close(sheet: &mut Sheet, ground: Option<&Ground>) -> u64 {
    let measured_m2: f32 = sheet.triangles.iter().map(|&triangle| area_m2(&sheet.positions, triangle)).sum();
    let is_small = |cap: &Cap| cap.area_m2() <= LARGEST * measured_m2;
    let (guessed, left_open): (Vec<_>, Vec<_>) = over_all(sheet, f64::INFINITY)
        .into_iter()
        .partition(|(_, cap)| is_small(cap) || ground.is_some_and(|ground| stands(cap, ground)));
    sew(sheet, guessed, ground);
    left_open.len() as u64
}

/// All rims up to a length, each with its cap.
fn over_all(sheet: &Sheet, longest_m: f64) -> Vec<(Vec<u32>, Cap)> {
    let with_cap = |rim: Vec<u32>| {
        let places: Vec<_> = rim.iter().map(|&v| sheet.positions[v as usize]).collect();
        (f64::from(length_m(&places)) <= longest_m).then(|| (rim, Cap::over(places)))
    };
    rims(sheet).into_par_iter().filter_map(with_cap).collect()
}

/// Whether a rim is as low as what stands on the table, on the whole.
fn stands(cap: &Cap, ground: &Ground) -> bool {
    let heights_m = cap.positions.iter().map(|p| ground.height_m(p));
    heights_m.sum::<f32>() <= ground.standing_m * cap.positions.len() as f32
}

fn sew(sheet: &mut Sheet, caps: Vec<(Vec<u32>, Cap)>, ground: Option<&Ground>) {
    let on_rim: HashSet<u32, KeyHash> = caps.iter().flat_map(|(rim, _)| rim).copied().collect();
    // A cap may not use an edge that the mesh already has: it would get a third triangle.
    let mut taken = Edges::default();
    for triangle in &sheet.triangles {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            if on_rim.contains(&a) && on_rim.contains(&b) {
                taken.insert(edge(a, b));
            }
        }
    }
    for (rim, cap) in caps {
        cap.sew(sheet, &rim, &taken, ground);
    }
}
