//! Holes in the final mesh: found as rims, closed by a cap.

use crate::cap::Cap;
use crate::sheet::Sheet;
use crate::topology::rims;
use std::collections::HashSet;
use std::f64::consts::PI;

/// Fills every hole whose rim is at most pi times `largest_m` long.
pub fn fill(sheet: &mut Sheet, largest_m: f64) {
    let rims: Vec<Vec<u32>> = rims(sheet).into_iter().filter(|rim| length_m(sheet, rim) <= PI * largest_m).collect();
    if rims.is_empty() {
        return;
    }
    let on_rim: HashSet<u32> = rims.iter().flatten().copied().collect();
    // A cap may not use an edge that the mesh already has: it would get a third triangle.
    let mut taken: HashSet<(u32, u32)> = HashSet::new();
    for triangle in &sheet.triangles {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            if on_rim.contains(&a) && on_rim.contains(&b) {
                taken.insert((a.min(b), a.max(b)));
            }
        }
    }
    for rim in rims {
        Cap::over(sheet, &rim, &taken).sew(sheet, &rim);
    }
}

fn length_m(sheet: &Sheet, rim: &[u32]) -> f64 {
    let at = |k: usize| sheet.positions[rim[k % rim.len()] as usize];
    (0..rim.len()).map(|k| f64::from((at(k + 1) - at(k)).norm())).sum()
}
