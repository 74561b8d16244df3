//! A cap over one hole: ears are cut off its rim, in the plane that fits it best, until nothing is left; then the cap is
//! refined and drawn tight.

use crate::refine::refine;
use crate::sheet::Sheet;
use nalgebra::{Vector2, Vector3};
use std::collections::HashSet;

/// A disc of triangles. Its first vertices are those of the rim, in order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cap {
    /// In the world, in metres.
    pub positions: Vec<Vector3<f32>>,
    /// How many of them are on the rim.
    pub rim: usize,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Edges between rim vertices, lower first, that the mesh around the hole has already.
    pub taken: HashSet<(u32, u32)>,
}

/// Which edge joins two vertices, whichever way.
pub fn edge(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

impl Cap {
    /// The cap over a rim; empty when no triangulation can be found that leaves the mesh a surface.
    pub fn over(sheet: &Sheet, rim: &[u32], taken: &HashSet<(u32, u32)>) -> Self {
        let mut cap = Self {
            positions: rim.iter().map(|&v| sheet.positions[v as usize]).collect(),
            rim: rim.len(),
            ..Self::default()
        };
        for (a, &global_a) in (0..).zip(rim) {
            for (b, &global_b) in (0..a).zip(rim) {
                // Neighbours on the rim are an edge of the cap as well.
                let beside = a - b == 1 || a - b == rim.len() as u32 - 1;
                if !beside && taken.contains(&edge(global_a, global_b)) {
                    cap.taken.insert((b, a));
                }
            }
        }
        if cap.cut_ears() {
            refine(&mut cap)
        } else {
            cap.triangles.clear()
        }
        cap
    }

    /// Adds the cap to the mesh. Nothing was measured there, so the sigma of its inner vertices is the hole's radius.
    pub fn sew(self, sheet: &mut Sheet, rim: &[u32]) {
        if self.triangles.is_empty() {
            return;
        }
        let at = |k: usize| self.positions[k % self.rim];
        let length: f32 = (0..self.rim).map(|k| (at(k + 1) - at(k)).norm()).sum();
        let sigma_m = length / std::f32::consts::TAU;
        let mut numbers = rim.to_vec();
        numbers.extend(self.positions[self.rim..].iter().map(|&p| sheet.add(p, Vector3::zeros(), sigma_m)));
        sheet.triangles.extend(self.triangles.iter().map(|t| t.map(|v| numbers[v as usize])));
    }

    /// The rim in its plane: the normal is that of its enclosed area (Newell).
    fn flattened(&self) -> Vec<Vector2<f32>> {
        let rim = &self.positions[..self.rim];
        let centre = rim.iter().sum::<Vector3<f32>>() / rim.len() as f32;
        let pairs = rim.iter().zip(rim.iter().cycle().skip(1));
        let area: Vector3<f32> = pairs.map(|(a, b)| (a - centre).cross(&(b - centre))).sum();
        let normal = area.try_normalize(0.0).unwrap_or_else(Vector3::z);
        let across = if normal.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let u = normal.cross(&across).normalize();
        let v = normal.cross(&u);
        rim.iter().map(|p| Vector2::new(u.dot(&(p - centre)), v.dot(&(p - centre)))).collect()
    }

    fn cut_ears(&mut self) -> bool {
        let flat = self.flattened();
        let mut left: Vec<u32> = (0..self.rim as u32).collect();
        let mut at = 0;
        while left.len() > 3 {
            let n = left.len();
            let corner = |k: usize| [left[(k + n - 1) % n], left[k % n], left[(k + 1) % n]];
            let free = |&k: &usize| {
                let [a, _, c] = corner(k);
                !self.taken.contains(&edge(a, c))
            };
            let mut in_turn = (at..at + n).map(|k| k % n).filter(free);
            // A rim that crosses itself in its plane may have no ear; then its sharpest corner has to do.
            let ear = in_turn.clone().find(|&k| is_ear(&flat, corner(k), &left));
            let sharpest =
                || in_turn.by_ref().min_by(|&j, &k| bend(&flat, corner(j)).total_cmp(&bend(&flat, corner(k))));
            let Some(k) = ear.or_else(sharpest) else { return false };
            self.triangles.push(corner(k));
            left.remove(k);
            // Going on behind the neighbour keeps all ears from meeting in one vertex.
            at = (k + 1) % left.len();
        }
        self.triangles.push([left[0], left[1], left[2]]);
        true
    }
}

fn turn(a: &Vector2<f32>, b: &Vector2<f32>, c: &Vector2<f32>) -> f32 {
    (b - a).perp(&(c - b))
}

/// Cosine of the angle at the middle one, negative for sharp corners.
fn bend(flat: &[Vector2<f32>], [a, b, c]: [u32; 3]) -> f32 {
    let [a, b, c] = [a, b, c].map(|v| flat[v as usize]);
    (b - a).normalize().dot(&(c - b).normalize())
}

fn is_ear(flat: &[Vector2<f32>], [a, b, c]: [u32; 3], left: &[u32]) -> bool {
    let corners = [a, b, c].map(|v| flat[v as usize]);
    let [p, q, r] = &corners;
    let within = |v: &&u32| {
        let x = &flat[**v as usize];
        ![a, b, c].contains(*v) && turn(p, q, x) >= 0.0 && turn(q, r, x) >= 0.0 && turn(r, p, x) >= 0.0
    };
    turn(p, q, r) > 0.0 && !left.iter().any(|v| within(&v))
}
