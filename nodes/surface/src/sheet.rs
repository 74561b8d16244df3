//! A surface under repair: plain arrays of vertices and triangles.

use crate::grid::{BlockKey, KeyHash};
use crate::marching::{EdgeKey, Patch, Vertex};
use nalgebra::Vector3;
use std::collections::{BTreeMap, HashMap};

/// Vertices and triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sheet {
    /// In the world, in metres.
    pub positions: Vec<Vector3<f32>>,
    /// Unit normals, outwards; zero where not known yet.
    pub normals: Vec<Vector3<f32>>,
    /// One standard deviation along the normal, in metres.
    pub sigmas_m: Vec<f32>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// So many of them, the first ones, were measured; `None`: all.
    pub measured: Option<usize>,
}

impl Sheet {
    /// Sews the patches of all blocks together: a vertex on the rim of a block is the same in each that has it.
    pub fn sew(patches: &BTreeMap<BlockKey, Patch>) -> Self {
        let mut sheet = Self::default();
        let mut shared: HashMap<EdgeKey, u32, KeyHash> = HashMap::default();
        let mut numbers = Vec::new();
        for patch in patches.values() {
            numbers.clear();
            for vertex in &patch.vertices {
                numbers.push(match vertex.shared {
                    true => *shared.entry(vertex.edge).or_insert_with(|| sheet.push(vertex)),
                    false => sheet.push(vertex),
                });
            }
            sheet.triangles.extend(patch.triangles.iter().map(|t| t.map(|v| numbers[v as usize])));
        }
        sheet
    }

    fn push(&mut self, vertex: &Vertex) -> u32 {
        self.add(vertex.position, vertex.normal, vertex.sigma_m)
    }

    /// Appends a vertex; returns its number.
    pub fn add(&mut self, position: Vector3<f32>, normal: Vector3<f32>, sigma_m: f32) -> u32 {
        self.positions.push(position);
        self.normals.push(normal);
        self.sigmas_m.push(sigma_m);
        self.positions.len() as u32 - 1
    }

    /// Twice the area times the unit normal.
    pub fn area_normal(&self, triangle: [u32; 3]) -> Vector3<f32> {
        let [a, b, c] = triangle.map(|v| self.positions[v as usize]);
        (b - a).cross(&(c - a))
    }

    /// Which way the surface faces at a triangle, by the normals of its vertices; by its own where those are not known.
    pub fn outwards(&self, triangle: [u32; 3]) -> Vector3<f32> {
        let known: Vector3<f32> = triangle.iter().map(|&v| self.normals[v as usize]).sum();
        if known == Vector3::zeros() { self.area_normal(triangle) } else { known }
    }

    /// Drops vertices that no triangle names; the others keep their order.
    pub fn compact(&mut self) {
        let mut used = vec![false; self.positions.len()];
        for &v in self.triangles.iter().flatten() {
            used[v as usize] = true;
        }
        let mut numbers = vec![0; used.len()];
        let mut kept = 0;
        for old in 0..used.len() {
            if used[old] {
                numbers[old] = kept as u32;
                self.positions[kept] = self.positions[old];
                self.normals[kept] = self.normals[old];
                self.sigmas_m[kept] = self.sigmas_m[old];
                kept += 1;
            }
        }
        self.positions.truncate(kept);
        self.normals.truncate(kept);
        self.sigmas_m.truncate(kept);
        for v in self.triangles.iter_mut().flatten() {
            *v = numbers[*v as usize];
        }
    }

    /// Gives each vertex whose normal is not known the mean of its triangles', weighted by their areas.
    pub fn complete_normals(&mut self) {
        let missing: Vec<bool> = self.normals.iter().map(|n| *n == Vector3::zeros()).collect();
        for triangle in &self.triangles {
            let normal = self.area_normal(*triangle);
            for &v in triangle {
                if missing[v as usize] {
                    self.normals[v as usize] += normal;
                }
            }
        }
        for (normal, _) in self.normals.iter_mut().zip(&missing).filter(|(_, missing)| **missing) {
            *normal = normal.try_normalize(0.0).unwrap_or_else(Vector3::z);
        }
    }

    /// As it travels.
    pub fn into_mesh(self, header: wire::Header) -> wire::Mesh {
        wire::Mesh {
            header,
            measured: self.measured.unwrap_or(self.triangles.len()) as u32,
            vertices_m: self.positions.into_iter().map(Into::into).collect(),
            normals: self.normals.into_iter().map(Into::into).collect(),
            sigma_m: self.sigmas_m.into(),
            triangles: self.triangles.into(),
        }
    }
}
