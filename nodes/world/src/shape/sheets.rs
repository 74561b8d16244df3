//! Which crossed edges of a cell belong to one sheet of the surface.
//!
//! Corner c of a cell has the bits x + 2y + 4z. An edge is numbered 4 axis + where it lies on the two axes after its own.

/// An edge that the surface does not cross.
pub const NONE: usize = usize::MAX;

/// The edge along an axis at a corner.
pub fn edge_at(corner: usize, axis: usize) -> usize {
    let bit = |axis: usize| corner >> (axis % 3) & 1;
    4 * axis + bit(axis + 1) + 2 * bit(axis + 2)
}

/// For each edge the number of its sheet, from 0 (at most four), or [`NONE`].
pub fn sheets(inside: &[bool; 8]) -> [usize; 12] {
    let mut root = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11];
    for face in 0..6 {
        for (a, b) in joined_on_face(inside, face / 2, face % 2) {
            let (from, to) = (root[a], root[b]);
            root.iter_mut().filter(|r| **r == from).for_each(|r| *r = to);
        }
    }
    let mut sheet_of_root = [NONE; 12];
    let mut sheet_of_edge = [NONE; 12];
    let mut count = 0;
    for (corner, axis) in (0..8).flat_map(|corner| (0..3).map(move |axis| (corner, axis))) {
        let edge = edge_at(corner, axis);
        if inside[corner] == inside[corner ^ 1 << axis] || sheet_of_edge[edge] != NONE {
            continue;
        }
        if sheet_of_root[root[edge]] == NONE {
            sheet_of_root[root[edge]] = count;
            count += 1;
        }
        sheet_of_edge[edge] = sheet_of_root[root[edge]];
    }
    sheet_of_edge
}

/// The pairs of crossed edges that a line of the surface joins on one face. Where it could go two ways it parts the
/// corners that are inside: the neighbour behind the face sees the same corners and decides alike.
fn joined_on_face(inside: &[bool; 8], normal: usize, side: usize) -> Vec<(usize, usize)> {
    let (u, v) = ((normal + 1) % 3, (normal + 2) % 3);
    let corner = |at: usize| side << normal | (at & 1) << u | (at >> 1) << v;
    let crossed = |at: usize, axis: usize| inside[corner(at)] != inside[corner(at) ^ 1 << axis];
    let edges = [(0, u), (2, u), (0, v), (1, v)];
    let all: Vec<usize> =
        edges.iter().filter(|(at, axis)| crossed(*at, *axis)).map(|(at, axis)| edge_at(corner(*at), *axis)).collect();
    match all[..] {
        [a, b] => vec![(a, b)],
        [_, _, _, _] => {
            let alone = (0..4).filter(|at| inside[corner(*at)]);
            alone.map(|at| (edge_at(corner(at), u), edge_at(corner(at), v))).collect()
        }
        _ => Vec::new(),
    }
}
