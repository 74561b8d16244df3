//! Where the surface has something to hold on to: borders between colours. Where it has none, lamp and normals are not
//! known well enough for shading to say where a camera was.

use crate::settle::consensus::Agreed;
use nalgebra::{Point3, Vector3};

/// Colours are compared within cubes of this edge.
const CUBE_M: f64 = 3e-3;
/// Fewer points in a cube say nothing.
const POINTS_MIN: usize = 8;
/// Of the values in a cube, this share at either end is left out.
const END_SHARE: f64 = 0.15;
/// Colours that differ by more than this (of the white of the picture) are a border.
const CONTRAST: f32 = 0.06;

/// True for the points that have a border between colours near them. Cubes are laid twice, the second time shifted by
/// half their edge, so that a border on the face of one is inside another.
pub fn with_detail(points: &[Point3<f64>], agreed: &[Agreed], white: f64) -> Vec<bool> {
    let mut detailed = vec![false; points.len()];
    for shift in [0.0, 0.5] {
        let mut cubes: Vec<([i32; 3], u32)> = (0..points.len() as u32)
            .filter(|&p| agreed[p as usize].mean().is_some())
            .map(|p| (cube_of(&points[p as usize], shift), p))
            .collect();
        cubes.sort_unstable();
        for cube in cubes.chunk_by(|a, b| a.0 == b.0) {
            if contrast(cube.iter().filter_map(|(_, p)| agreed[*p as usize].mean())) > CONTRAST * white as f32 {
                cube.iter().for_each(|(_, p)| detailed[*p as usize] = true);
            }
        }
    }
    detailed
}

fn cube_of(point: &Point3<f64>, shift: f64) -> [i32; 3] {
    (point.coords / CUBE_M + Vector3::repeat(shift)).map(|c| c.floor() as i32).into()
}

/// The largest difference in a channel, without the ends.
fn contrast(values: impl Iterator<Item = [f32; 3]>) -> f32 {
    let values: Vec<[f32; 3]> = values.collect();
    if values.len() < POINTS_MIN {
        return 0.0;
    }
    let spread = |channel: usize| {
        let mut sorted: Vec<f32> = values.iter().map(|value| value[channel]).collect();
        sorted.sort_unstable_by(f32::total_cmp);
        let end = (END_SHARE * sorted.len() as f64) as usize;
        sorted[sorted.len() - 1 - end] - sorted[end]
    };
    (0..3).map(spread).fold(0.0, f32::max)
}
