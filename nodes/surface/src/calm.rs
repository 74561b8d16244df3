//! Along sharp rims and creases, narrower than the grid can follow, neighbouring vertices land on one face or the other, and the
//! edge comes out as a saw. There, and only there, vertices are drawn to the mean of their neighbours.

use crate::sheet::Sheet;
use crate::stars::Stars;
use nalgebra::Vector3;

/// A vertex is on a saw when a triangle at it stands at more than 50 degrees to the vertex's own normal.
const LEAST_COSINE: f32 = 0.64;
const ROUNDS: usize = 3;

/// Smooths the saws; rims stay as they are.
pub fn calm(sheet: &mut Sheet) {
    let stars = Stars::new(sheet);
    for _ in 0..ROUNDS {
        let on_saw = |&v: &u32| {
            let normal = sheet.normals[v as usize];
            let askew = |&t: &u32| {
                let facing = sheet.area_normal(sheet.triangles[t as usize]);
                facing.dot(&normal) < LEAST_COSINE * facing.norm()
            };
            !stars.on_rim(v) && normal != Vector3::zeros() && stars.of(v).iter().any(askew)
        };
        let moved: Vec<(u32, Vector3<f32>)> = (0..sheet.positions.len() as u32)
            .filter(on_saw)
            .map(|v| (v, stars.ring(sheet, v)))
            .map(|(v, ring)| {
                (v, ring.iter().map(|&w| sheet.positions[w as usize]).sum::<Vector3<f32>>() / ring.len() as f32)
            })
            .collect();
        for (v, to) in moved {
            sheet.positions[v as usize] = (sheet.positions[v as usize] + to) * 0.5;
        }
    }
}
