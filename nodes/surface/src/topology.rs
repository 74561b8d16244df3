//! Which triangles hang together, and how.

use crate::sheet::Sheet;
use nalgebra::Vector3;
use rayon::prelude::*;

/// An edge of a triangle with the lower vertex first: both vertices, then which corner of which triangle it begins at
/// (3 triangle + k, from corner k to corner k + 1).
pub type HalfEdge = (u32, u32, u32);

/// All edges of all triangles, those between the same vertices side by side.
pub fn half_edges(triangles: &[[u32; 3]]) -> Vec<HalfEdge> {
    let of = |(t, triangle): (usize, &[u32; 3])| {
        let triangle = *triangle;
        (0..3).map(move |k| {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            (a.min(b), a.max(b), (3 * t + k) as u32)
        })
    };
    let mut edges: Vec<HalfEdge> = triangles.iter().enumerate().flat_map(of).collect();
    edges.par_sort_unstable();
    edges
}

/// Runs of half-edges between the same two vertices.
pub fn runs(edges: &[HalfEdge]) -> impl Iterator<Item = &[HalfEdge]> {
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
}

/// Sets of numbers that can be joined (Tarjan); the smallest member stands for its set.
pub struct Sets(Vec<u32>);

impl Sets {
    /// Each number by itself.
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// Who stands for the set of this number.
    pub fn find(&mut self, mut member: u32) -> u32 {
        while self.0[member as usize] != member {
            let above = self.0[self.0[member as usize] as usize];
            self.0[member as usize] = above;
            member = above;
        }
        member
    }

    /// Makes two sets one.
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// Where two fans of triangles touch in a single vertex, each gets a vertex of its own.
pub fn split_bow_ties(sheet: &mut Sheet) {
    // Corners of triangles, joined across every edge that two triangles share, are the fans.
    let mut fans = Sets::new(3 * sheet.triangles.len());
    let edges = half_edges(&sheet.triangles);
    for run in runs(&edges) {
        if let [(low, _, first), (_, _, second)] = *run {
            let ends = |half_edge: u32| {
                let (t, k) = (half_edge / 3, half_edge % 3);
                let next = 3 * t + (k + 1) % 3;
                let begins_low = sheet.triangles[t as usize][k as usize] == low;
                if begins_low { [half_edge, next] } else { [next, half_edge] }
            };
            let ([a, b], [c, d]) = (ends(first), ends(second));
            fans.join(a, c);
            fans.join(b, d);
        }
    }
    let mut fan_of_vertex = vec![u32::MAX; sheet.positions.len()];
    let mut vertex_of_fan = vec![u32::MAX; 3 * sheet.triangles.len()];
    for corner in 0..3 * sheet.triangles.len() as u32 {
        let (t, k) = ((corner / 3) as usize, (corner % 3) as usize);
        let v = sheet.triangles[t][k] as usize;
        let fan = fans.find(corner);
        if vertex_of_fan[fan as usize] == u32::MAX {
            let first = fan_of_vertex[v] == u32::MAX;
            fan_of_vertex[v] = fan;
            vertex_of_fan[fan as usize] =
                if first { v as u32 } else { sheet.add(sheet.positions[v], sheet.normals[v], sheet.sigmas_m[v]) };
        }
        sheet.triangles[t][k] = vertex_of_fan[fan as usize];
    }
}

/// Of the square of an island's least diagonal, its least area: a strip may be long and still be nothing.
const LEAST_SHARE_OF_SQUARE: f32 = 0.25;

/// In square metres.
pub fn area_m2(positions: &[Vector3<f32>], triangle: [u32; 3]) -> f32 {
    let [a, b, c] = triangle.map(|v| positions[v as usize]);
    0.5 * (b - a).cross(&(c - a)).norm()
}

/// Drops the pieces whose bounding box has a shorter diagonal than this, or that have less area than a quarter of its square.
pub fn drop_islands(sheet: &mut Sheet, shortest_m: f32) {
    let mut pieces = Sets::new(sheet.positions.len());
    for &[a, b, c] in &sheet.triangles {
        pieces.join(a, b);
        pieces.join(b, c);
    }
    let nowhere = [Vector3::repeat(f32::INFINITY), Vector3::repeat(f32::NEG_INFINITY)];
    let mut boxes = vec![nowhere; sheet.positions.len()];
    for (v, p) in (0..).zip(&sheet.positions) {
        let [low, high] = &mut boxes[pieces.find(v) as usize];
        (*low, *high) = (low.inf(p), high.sup(p));
    }
    let mut areas_m2 = vec![0.0; sheet.positions.len()];
    for &triangle in &sheet.triangles {
        areas_m2[pieces.find(triangle[0]) as usize] += area_m2(&sheet.positions, triangle);
    }
    sheet.triangles.retain(|triangle| {
        let piece = pieces.find(triangle[0]) as usize;
        let [low, high] = boxes[piece];
        (high - low).norm() >= shortest_m && areas_m2[piece] >= LEAST_SHARE_OF_SQUARE * shortest_m * shortest_m
    });
}

/// The rims: closed loops of vertices, in the order in which a triangle that fills them runs along them.
pub fn rims(sheet: &Sheet) -> Vec<Vec<u32>> {
    const NONE: u32 = u32::MAX;
    let mut next = vec![NONE; sheet.positions.len()];
    let edges = half_edges(&sheet.triangles);
    for run in runs(&edges) {
        if let [(_, _, half_edge)] = *run {
            let triangle = sheet.triangles[(half_edge / 3) as usize];
            let k = (half_edge % 3) as usize;
            // The filling triangle runs the other way along the edge.
            next[triangle[(k + 1) % 3] as usize] = triangle[k];
        }
    }
    let mut rims = Vec::new();
    for start in 0..next.len() {
        let mut rim = Vec::new();
        let mut v = start;
        while next[v] != NONE {
            rim.push(v as u32);
            v = std::mem::replace(&mut next[v], NONE) as usize;
        }
        // A walk that does not come back to its start would be a fault of the mesh: nothing to fill.
        if v == start && rim.len() >= 3 {
            rims.push(rim);
        }
    }
    rims
}
