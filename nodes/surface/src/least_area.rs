//! The triangulation of a closed loop in space that has the least area (Barequet and Sharir 1995).

use crate::grid::KeyHash;
use nalgebra::Vector3;
use std::collections::HashMap;

/// The work grows with the cube of the count: of a longer loop so many vertices, evenly spread, are triangulated first.
const MOST: usize = 200;
/// Where areas are equal, as they all are in a plane, round triangles are better: so much of the squares of their edges counts too.
const ROUNDNESS: f32 = 0.01;

/// Triangles over a loop of three vertices or more, by the places of their corners in it; each edge of the loop has one.
pub fn triangulate(ring: &[Vector3<f32>]) -> Vec<[u32; 3]> {
    let count = ring.len().min(MOST);
    let picked: Vec<u32> = (0..count).map(|k| (k * ring.len() / count) as u32).collect();
    let corners: Vec<Vector3<f32>> = picked.iter().map(|&v| ring[v as usize]).collect();
    let mut triangles: Vec<[u32; 3]> = of_few(&corners).into_iter().map(|t| t.map(|v| picked[v])).collect();
    put_back(&mut triangles, &picked, ring.len() as u32);
    triangles
}

fn cost(a: &Vector3<f32>, b: &Vector3<f32>, c: &Vector3<f32>) -> f32 {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    0.5 * ab.cross(&bc).norm() + ROUNDNESS * (ab.norm_squared() + bc.norm_squared() + ca.norm_squared())
}

/// The best triangulation between the corners i and k has a triangle i, j, k and the best ones to both sides of it.
fn of_few(corners: &[Vector3<f32>]) -> Vec<[usize; 3]> {
    let count = corners.len();
    let mut least = vec![0f32; count * count];
    let mut apex = vec![0; count * count];
    for apart in 2..count {
        for i in 0..count - apart {
            let k = i + apart;
            let with =
                |j: usize| least[i * count + j] + least[j * count + k] + cost(&corners[i], &corners[j], &corners[k]);
            let best = (i + 1..k).map(|j| (with(j), j)).min_by(|x, y| x.0.total_cmp(&y.0));
            (least[i * count + k], apex[i * count + k]) = best.unwrap_or_default();
        }
    }
    let mut triangles = Vec::with_capacity(count - 2);
    let mut open = vec![(0, count - 1)];
    while let Some((i, k)) = open.pop() {
        if k - i >= 2 {
            let j = apex[i * count + k];
            triangles.push([i, j, k]);
            open.extend([(i, j), (j, k)]);
        }
    }
    triangles
}

/// Splits the edges of the loop at the vertices that were passed over, the middle one first.
fn put_back(triangles: &mut Vec<[u32; 3]>, picked: &[u32], count: u32) {
    let edges = |(t, &[a, b, c]): (usize, &[u32; 3])| [((a, b), t), ((b, c), t), ((c, a), t)];
    let mut left: HashMap<(u32, u32), usize, KeyHash> = triangles.iter().enumerate().flat_map(edges).collect();
    let ends = picked.iter().copied().zip(picked.iter().copied().skip(1).chain([count]));
    let mut spans: Vec<(u32, u32)> = ends.filter(|(first, last)| last - first >= 2).collect();
    while let Some((first, last)) = spans.pop() {
        let (middle, end) = ((first + last) / 2, last % count);
        let Some(t) = left.remove(&(first, end)) else { continue };
        let Some(&apex) = triangles[t].iter().find(|&&v| v != first && v != end) else { continue };
        let other = triangles.len();
        triangles[t] = [first, middle, apex];
        triangles.push([middle, end, apex]);
        left.extend([((first, middle), t), ((middle, end), other), ((end, apex), other)]);
        spans.extend([(first, middle), (middle, last)].iter().filter(|(first, last)| last - first >= 2));
    }
}
