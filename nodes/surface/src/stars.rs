//! The triangles at each vertex, kept up while a mesh is repaired.

use crate::sheet::Sheet;
use crate::topology::{half_edges, runs};

/// Stars of all vertices.
pub struct Stars {
    of_vertex: Vec<Vec<u32>>,
    on_rim: Vec<bool>,
}

impl Stars {
    /// As the mesh is now.
    pub fn new(sheet: &Sheet) -> Self {
        let mut of_vertex = vec![Vec::new(); sheet.positions.len()];
        for (t, triangle) in (0u32..).zip(&sheet.triangles) {
            for &v in triangle {
                of_vertex[v as usize].push(t);
            }
        }
        let mut on_rim = vec![false; sheet.positions.len()];
        for run in runs(&half_edges(&sheet.triangles)) {
            if run.len() != 2 {
                on_rim[run[0].0 as usize] = true;
                on_rim[run[0].1 as usize] = true;
            }
        }
        Self { of_vertex, on_rim }
    }

    /// The triangles at a vertex.
    pub fn of(&self, v: u32) -> &[u32] {
        &self.of_vertex[v as usize]
    }

    /// Whether a vertex lay on a rim when the stars were made.
    pub fn on_rim(&self, v: u32) -> bool {
        self.on_rim[v as usize]
    }

    /// The neighbours of a vertex, in the order of their numbers.
    pub fn ring(&self, sheet: &Sheet, v: u32) -> Vec<u32> {
        let star = self.of(v).iter();
        let mut ring: Vec<u32> = star.flat_map(|&t| sheet.triangles[t as usize]).filter(|&w| w != v).collect();
        ring.sort_unstable();
        ring.dedup();
        ring
    }

    /// Empties the star of a vertex.
    pub fn take(&mut self, v: u32) -> Vec<u32> {
        std::mem::take(&mut self.of_vertex[v as usize])
    }

    /// Takes a triangle out of a star.
    pub fn remove(&mut self, v: u32, t: u32) {
        self.of_vertex[v as usize].retain(|&other| other != t);
    }

    /// Puts a triangle into a star.
    pub fn insert(&mut self, v: u32, t: u32) {
        self.of_vertex[v as usize].push(t);
    }
}
