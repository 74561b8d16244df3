//! A cap over one hole: the triangulation of its rim that has the least area, refined and drawn tight.

use crate::grid::KeyHash;
use crate::ground::Ground;
use crate::refine::refine;
use crate::sheet::Sheet;
use crate::{least_area, topology};
use nalgebra::Vector3;
use std::collections::HashSet;

/// Edges by their ends, the lower first.
pub type Edges = HashSet<(u32, u32), KeyHash>;

/// A disc of triangles. Its first vertices are those of the rim, in order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cap {
    /// In the world, in metres.
    pub positions: Vec<Vector3<f32>>,
    /// How many of them are on the rim.
    pub rim: usize,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Edges between rim vertices that the mesh around the hole has already.
    pub taken: Edges,
}

/// Which edge joins two vertices, whichever way.
pub fn edge(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

/// Length of a closed loop, in metres.
pub fn length_m(rim: &[Vector3<f32>]) -> f32 {
    let at = |k: usize| rim[k % rim.len()];
    (0..rim.len()).map(|k| (at(k + 1) - at(k)).norm()).sum()
}

impl Cap {
    /// The cap over a rim, as coarse as the rim allows.
    pub fn over(rim: Vec<Vector3<f32>>) -> Self {
        Self { triangles: least_area::triangulate(&rim), rim: rim.len(), positions: rim, taken: Edges::default() }
    }

    /// In square metres.
    pub fn area_m2(&self) -> f32 {
        self.triangles.iter().map(|&triangle| topology::area_m2(&self.positions, triangle)).sum()
    }

    /// Length of the rim, in metres.
    pub fn length_m(&self) -> f32 {
        length_m(&self.positions[..self.rim])
    }

    /// Makes its triangles as small as those around it, and adds it to the mesh. `taken` has the edges between vertices of
    /// rims that the mesh has already. Nothing was measured there, so the sigma of its inner vertices is the
    /// hole's radius.
    pub fn sew(mut self, sheet: &mut Sheet, rim: &[u32], taken: &Edges, ground: Option<&Ground>) {
        for (a, &global_a) in (0..).zip(rim) {
            for (b, &global_b) in (0..a).zip(rim) {
                // Neighbours on the rim are an edge of the cap as well.
                let beside = a - b == 1 || a - b == rim.len() as u32 - 1;
                if !beside && taken.contains(&edge(global_a, global_b)) {
                    self.taken.insert((b, a));
                }
            }
        }
        let sigma_m = self.length_m() / std::f32::consts::TAU;
        refine(&mut self, ground);
        let mut numbers = rim.to_vec();
        numbers.extend(self.positions[self.rim..].iter().map(|&p| sheet.add(p, Vector3::zeros(), sigma_m)));
        sheet.triangles.extend(self.triangles.iter().map(|t| t.map(|v| numbers[v as usize])));
    }
}
