//! The table of the marching cubes (Lorensen and Cline 1987), derived instead of typed in.
//!
//! Corner c of a cell stands at (c & 1, c >> 1 & 1, c >> 2); edge 4 axis + k is the k-th that runs along an axis. On a face
//! with two crossings they are joined; on one with four, each corner that lies outside is cut off by itself. That depends on the
//! signs of the face alone, so two cells that share a face always agree, and the mesh has no cracks. The outline that
//! results is triangulated without any chord inside a face: the cell beyond could have the same chord, and an edge
//! would have four triangles.

use std::sync::LazyLock;

/// Triangles of a cell: three of its edges each, counter-clockwise seen from outside (the positive side).
pub type Case = Vec<[u8; 3]>;

/// The triangles for each set of corners that lie inside (bit c set: the distance at corner c is negative).
pub static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| (0..=255).map(triangles).collect());

/// The two corners of each edge, the lower first.
pub const EDGES: [[u8; 2]; 12] = [
    [0, 1],
    [2, 3],
    [4, 5],
    [6, 7], // along x
    [0, 2],
    [1, 3],
    [4, 6],
    [5, 7], // along y
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7], // along z
];

/// The corners of each face, counter-clockwise seen from outside the cell.
const FACES: [[u8; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

fn edge_between(a: u8, b: u8) -> u8 {
    EDGES.iter().position(|&[c, d]| (c, d) == (a.min(b), a.max(b))).map_or(u8::MAX, |e| e as u8)
}

/// Which faces an edge belongs to, as bits.
fn faces_of(edge: u8) -> u8 {
    let [a, b] = EDGES[edge as usize];
    (0..6).filter(|&f| FACES[f].contains(&a) && FACES[f].contains(&b)).map(|f| 1 << f).sum()
}

/// For each crossed edge the one that follows it on the outline, with the inside on the left of the face.
fn successors(inside: u8) -> [Option<u8>; 12] {
    let is_inside = |corner: u8| inside >> corner & 1 == 1;
    let mut next = [None; 12];
    for face in FACES {
        // Around the face: where its rim goes in, and where it comes out again.
        let crossings: Vec<(u8, bool)> = (0..4)
            .map(|k| (face[k], face[(k + 1) % 4]))
            .filter(|&(a, b)| is_inside(a) != is_inside(b))
            .map(|(a, b)| (edge_between(a, b), is_inside(b)))
            .collect();
        for (k, &(edge, enters)) in crossings.iter().enumerate() {
            if enters {
                // The crossing just before: the piece between them is the corner outside that is cut off.
                let (before, _) = crossings[(k + crossings.len() - 1) % crossings.len()];
                next[edge as usize] = Some(before);
            }
        }
    }
    next
}

fn outlines(inside: u8) -> Vec<Vec<u8>> {
    let next = successors(inside);
    let mut seen = [false; 12];
    let mut outlines = Vec::new();
    for start in 0..12u8 {
        let mut outline = Vec::new();
        let mut edge = start;
        while let (false, Some(after)) = (seen[edge as usize], next[edge as usize]) {
            seen[edge as usize] = true;
            outline.push(edge);
            edge = after;
        }
        if !outline.is_empty() {
            outlines.push(outline);
        }
    }
    outlines
}

/// Triangulates `outline[from..=to]` over the chord from its first to its last edge.
fn fill(outline: &[u8], from: usize, to: usize, triangles: &mut Case) -> bool {
    if to - from < 2 {
        return true;
    }
    let chord = |a: usize, b: usize| {
        let on_outline = b - a == 1 || (a == 0 && b == outline.len() - 1);
        on_outline || faces_of(outline[a]) & faces_of(outline[b]) == 0
    };
    let length = triangles.len();
    for apex in from + 1..to {
        if chord(from, apex) && chord(apex, to) {
            triangles.push([outline[from], outline[apex], outline[to]]);
            if fill(outline, from, apex, triangles) && fill(outline, apex, to, triangles) {
                return true;
            }
            triangles.truncate(length);
        }
    }
    false
}

fn triangles(inside: u8) -> Case {
    let mut triangles = Case::new();
    for outline in outlines(inside) {
        let whole = fill(&outline, 0, outline.len() - 1, &mut triangles);
        debug_assert!(whole, "case {inside:08b} has an outline {outline:?} without a triangulation");
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::{CASES, outlines};

    #[test]
    fn every_case_is_whole() {
        for inside in 0..=255u8 {
            let wanted: usize = outlines(inside).iter().map(|outline| outline.len() - 2).sum();
            assert_eq!(CASES[inside as usize].len(), wanted, "case {inside:08b}");
        }
        assert_eq!(CASES[0b0000_0001], vec![[0, 4, 8]], "one corner inside: seen from (1, 1, 1), x y z");
    }
}
