//! Flat triangles without short edges: their longest edge is flipped, which gives each of the two triangles at it a height.

use crate::sheet::Sheet;
use crate::stars::Stars;
use nalgebra::Vector3;

/// Height over longest edge (equilateral: 0.87) below which a triangle is flat.
const FLAT: f32 = 0.2;
/// Triangles after a flip stand at no more than 60 degrees to the surface.
const LEAST_COSINE: f32 = 0.5;
const ROUNDS: usize = 3;

/// Flips the longest edges of flat triangles wherever that betters the worse of the two.
pub fn flip(sheet: &mut Sheet) {
    let mut stars = Stars::new(sheet);
    for _ in 0..ROUNDS {
        let mut flipped = false;
        for t in 0..sheet.triangles.len() as u32 {
            if roundness(sheet, sheet.triangles[t as usize]) < FLAT {
                flipped |= try_flip(sheet, &mut stars, t);
            }
        }
        if !flipped {
            break;
        }
    }
}

fn corners(sheet: &Sheet, triangle: [u32; 3]) -> [Vector3<f32>; 3] {
    triangle.map(|v| sheet.positions[v as usize])
}

/// Height over longest edge.
fn roundness(sheet: &Sheet, triangle: [u32; 3]) -> f32 {
    let [a, b, c] = corners(sheet, triangle);
    let longest_squared = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
    (b - a).cross(&(c - a)).norm() / longest_squared
}

fn faces_outwards(sheet: &Sheet, triangle: [u32; 3], outwards: &Vector3<f32>) -> bool {
    let normal = sheet.area_normal(triangle);
    normal.dot(outwards) > LEAST_COSINE * normal.norm() * outwards.norm()
}

/// The triangle turned so that its longest edge comes first.
fn longest_first(sheet: &Sheet, [a, b, c]: [u32; 3]) -> [u32; 3] {
    let length = |v: u32, w: u32| (sheet.positions[v as usize] - sheet.positions[w as usize]).norm_squared();
    let turned = [[a, b, c], [b, c, a], [c, a, b]];
    turned.into_iter().max_by(|x, y| length(x[0], x[1]).total_cmp(&length(y[0], y[1]))).unwrap_or([a, b, c])
}

fn try_flip(sheet: &mut Sheet, stars: &mut Stars, t: u32) -> bool {
    let [a, b, c] = longest_first(sheet, sheet.triangles[t as usize]);
    let mut at_edge = stars.of(a).iter().filter(|&&s| s != t && sheet.triangles[s as usize].contains(&b));
    let Some(&other) = at_edge.next() else { return false };
    let Some(d) = sheet.triangles[other as usize].into_iter().find(|&v| v != a && v != b) else { return false };
    // A second edge between c and d would have four triangles; a and b need three edges after losing one.
    if stars.ring(sheet, c).binary_search(&d).is_ok() || stars.of(a).len() < 4 || stars.of(b).len() < 4 {
        return false;
    }
    let (before, after) = ([[a, b, c], [b, a, d]], [[a, d, c], [d, b, c]]);
    let worst = |pair: &[[u32; 3]; 2]| roundness(sheet, pair[0]).min(roundness(sheet, pair[1]));
    let outwards = sheet.outwards([a, b, c]) + sheet.outwards([b, a, d]);
    if worst(&after) <= worst(&before) || !after.iter().all(|&triangle| faces_outwards(sheet, triangle, &outwards)) {
        return false;
    }
    sheet.triangles[t as usize] = after[0];
    sheet.triangles[other as usize] = after[1];
    stars.remove(a, other);
    stars.remove(b, t);
    stars.insert(c, other);
    stars.insert(d, t);
    true
}
