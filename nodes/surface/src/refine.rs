//! Makes a cap's triangles as large and as round as those around it (after Liepa 2003): long edges are split, edges
//! flipped until the triangulation is Delaunay, and the inner vertices drawn to the mean of their neighbours, so that the cap is
//! a membrane over its rim.

use crate::cap::{Cap, edge};
use crate::grid::KeyHash;
use crate::ground::Ground;
use std::collections::HashMap;

/// Edges longer than this share of the rim's mean edge are split.
const LONGEST: f32 = 1.5;
const ROUNDS: usize = 14;
const FLIP_PASSES: usize = 8;
const RELAXATIONS: usize = 8;
const LAST_RELAXATIONS: usize = 60;

/// For each directed edge the triangle on its left.
type Left = HashMap<(u32, u32), u32, KeyHash>;

fn left_of(cap: &Cap) -> Left {
    let edges = |(t, &[a, b, c]): (u32, &[u32; 3])| [((a, b), t), ((b, c), t), ((c, a), t)];
    (0..).zip(&cap.triangles).flat_map(edges).collect()
}

fn opposite(triangle: [u32; 3], a: u32, b: u32) -> u32 {
    triangle.into_iter().find(|&v| v != a && v != b).unwrap_or(a)
}

/// Two triangles with the edge between them: its ends a and b, and c and d opposite, to its left and right.
struct Hinge {
    triangles: [u32; 2],
    ends: [u32; 2],
    opposite: [u32; 2],
}

/// The inner edges, in the order of the triangles.
fn hinges(cap: &Cap, left: &Left) -> Vec<Hinge> {
    let mut hinges = Vec::new();
    for (t, &triangle) in (0..).zip(&cap.triangles) {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            if let (true, Some(&other)) = (a < b, left.get(&(b, a))) {
                let opposite = [opposite(triangle, a, b), opposite(cap.triangles[other as usize], a, b)];
                hinges.push(Hinge { triangles: [t, other], ends: [a, b], opposite });
            }
        }
    }
    hinges
}

/// Splits, flips and relaxes until no edge is too long; then lays what is low onto the ground, and what would be below it.
pub fn refine(cap: &mut Cap, ground: Option<&Ground>) {
    let longest_m = LONGEST * cap.length_m() / cap.rim as f32;
    // An edge that the mesh has already would get a third triangle. Halves of it are new edges.
    while split(cap, |cap, [a, b], _| cap.taken.contains(&edge(a, b))) {}
    flip(cap);
    for _ in 0..ROUNDS {
        if !split(cap, |_, _, length_m| length_m > longest_m) {
            break;
        }
        flip(cap);
        relax(cap, RELAXATIONS, |_| true);
        flip(cap);
    }
    relax(cap, LAST_RELAXATIONS, |_| true);
    if let Some(ground) = ground {
        let inner = |cap: &mut Cap, below_m: f32| -> Vec<bool> {
            cap.positions.iter_mut().skip(cap.rim).map(|p| ground.lay(p, below_m)).collect()
        };
        let laid = inner(cap, ground.standing_m);
        let rim = cap.rim;
        relax(cap, LAST_RELAXATIONS, |v| !laid[v - rim]);
        inner(cap, 0.0);
    }
}

/// Halves the inner edges that are to be (by their ends and their length), the longest first, each triangle at most once.
fn split(cap: &mut Cap, is_to_be: impl Fn(&Cap, [u32; 2], f32) -> bool) -> bool {
    let length = |h: &Hinge| (cap.positions[h.ends[0] as usize] - cap.positions[h.ends[1] as usize]).norm();
    let all = hinges(cap, &left_of(cap)).into_iter().map(|h| (length(&h), h));
    let mut long: Vec<(f32, Hinge)> = all.filter(|(length_m, h)| is_to_be(cap, h.ends, *length_m)).collect();
    long.sort_by(|x, y| y.0.total_cmp(&x.0).then(x.1.ends.cmp(&y.1.ends)));
    let mut touched = vec![false; cap.triangles.len()];
    for (_, Hinge { triangles: [s, t], ends: [a, b], opposite: [c, d] }) in &long {
        let (s, t) = (*s as usize, *t as usize);
        if touched[s] || touched[t] {
            continue;
        }
        (touched[s], touched[t]) = (true, true);
        let middle = cap.positions.len() as u32;
        cap.positions.push((cap.positions[*a as usize] + cap.positions[*b as usize]) * 0.5);
        cap.triangles[s] = [*a, middle, *c];
        cap.triangles[t] = [*b, middle, *d];
        cap.triangles.push([middle, *b, *c]);
        cap.triangles.push([middle, *a, *d]);
    }
    !long.is_empty()
}

/// Flips inner edges whose opposite angles sum to more than half a turn.
fn flip(cap: &mut Cap) {
    for _ in 0..FLIP_PASSES {
        let mut left = left_of(cap);
        let mut touched = vec![false; cap.triangles.len()];
        let mut flipped = false;
        for Hinge { triangles: [s, t], ends: [a, b], opposite: [c, d] } in hinges(cap, &left) {
            let exists = left.contains_key(&(c, d)) || left.contains_key(&(d, c)) || cap.taken.contains(&edge(c, d));
            if touched[s as usize] || touched[t as usize] || exists || !wants_flip(cap, [a, b], [c, d]) {
                continue;
            }
            (touched[s as usize], touched[t as usize]) = (true, true);
            cap.triangles[s as usize] = [a, d, c];
            cap.triangles[t as usize] = [d, b, c];
            left.insert((d, c), s);
            left.insert((c, d), t);
            flipped = true;
        }
        if !flipped {
            break;
        }
    }
}

fn wants_flip(cap: &Cap, [a, b]: [u32; 2], [c, d]: [u32; 2]) -> bool {
    let [a, b, c, d] = [a, b, c, d].map(|v| cap.positions[v as usize]);
    let angle = |apex: &nalgebra::Vector3<f32>| (a - apex).angle(&(b - apex));
    let (first, second) = ((d - a).cross(&(c - a)), (b - d).cross(&(c - d)));
    // The slack keeps four vertices on a circle from flipping for ever.
    angle(&c) + angle(&d) > std::f32::consts::PI + 1e-3 && first.dot(&second) > 0.0
}

/// Draws each inner vertex that is free to the mean of its neighbours, in the order of their numbers.
fn relax(cap: &mut Cap, times: usize, is_free: impl Fn(usize) -> bool) {
    let mut neighbours = vec![Vec::new(); cap.positions.len()];
    for &[a, b, c] in &cap.triangles {
        // Around an inner vertex every neighbour is the next of exactly one triangle.
        neighbours[a as usize].push(b);
        neighbours[b as usize].push(c);
        neighbours[c as usize].push(a);
    }
    for _ in 0..times {
        let inner = neighbours.iter().enumerate().skip(cap.rim);
        for (v, ring) in inner.filter(|(v, ring)| !ring.is_empty() && is_free(*v)) {
            let sum: nalgebra::Vector3<f32> = ring.iter().map(|&w| cap.positions[w as usize]).sum();
            cap.positions[v] = sum / ring.len() as f32;
        }
    }
}
