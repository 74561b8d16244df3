//! Sides for planes that nobody saw (Hoppe et al. 1992, section 3.3): along a minimum spanning tree of the Riemannian graph,
//! whose edges join near planes and cost 1 - |n . n'|, so that the side is carried where the surface bends least.
//!
//! Planes with a known side are the roots. A component without any is rooted at its highest plane, turned upwards.

use crate::grid::{BlockKey, Grid, around};
use crate::plane::Plane;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Planes within so many voxels are joined: less than the thickness of a sheet, or sides would jump across it.
const JOIN_VOXELS: f32 = 2.0;

/// An edge of the tree to be: its cost, then the planes by number, so that ties always fall the same way.
type Edge = Reverse<(u32, u32, u32)>;

struct Graph {
    positions: Vec<Vector3<f32>>,
    normals: Vec<Vector3<f32>>,
    /// Neighbours of plane i: `neighbours[starts[i]..starts[i + 1]]`.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
}

impl Graph {
    fn new(grid: &Grid, planes: &BTreeMap<BlockKey, Vec<Plane>>) -> Self {
        let mut first = BTreeMap::new();
        let mut count = 0u32;
        for (&key, planes) in planes {
            first.insert(key, count);
            count += planes.len() as u32;
        }
        let join_squared = (JOIN_VOXELS * grid.voxel_m()).powi(2);
        let keys: Vec<BlockKey> = planes.keys().copied().collect();
        let per_block: Vec<Vec<Vec<u32>>> = keys
            .par_iter()
            .map(|&key| {
                let near: Vec<(u32, Vector3<f32>)> = around(key)
                    .filter_map(|k| Some((first.get(&k)?, planes.get(&k)?)))
                    .flat_map(|(first, planes)| planes.iter().zip(*first..).map(|(p, index)| (index, p.position)))
                    .filter(|(_, p)| grid.distance_squared(key, p) < join_squared)
                    .collect();
                let joined = |p: &Plane| {
                    let close = |(_, q): &&(u32, Vector3<f32>)| (q - p.position).norm_squared() < join_squared;
                    near.iter().filter(close).map(|&(index, _)| index).collect()
                };
                planes[&key].iter().map(joined).collect()
            })
            .collect();
        let mut starts = vec![0];
        let mut neighbours = Vec::new();
        for of_plane in per_block.iter().flatten() {
            neighbours.extend_from_slice(of_plane);
            starts.push(neighbours.len() as u32);
        }
        let all = || planes.values().flatten();
        Self {
            positions: all().map(|p| p.position).collect(),
            normals: all().map(|p| p.normal).collect(),
            starts,
            neighbours,
        }
    }

    fn cost(&self, a: u32, b: u32) -> u32 {
        // A cost between 0 and 1 is never negative, so its bits are ordered as it is.
        (1.0 - self.normals[a as usize].dot(&self.normals[b as usize]).abs()).max(0.0).to_bits()
    }

    /// Prim's algorithm from what is in the heap.
    fn grow(&mut self, done: &mut [bool], heap: &mut BinaryHeap<Edge>) {
        while let Some(Reverse((_, from, to))) = heap.pop() {
            if std::mem::replace(&mut done[to as usize], true) {
                continue;
            }
            if self.normals[from as usize].dot(&self.normals[to as usize]) < 0.0 {
                self.normals[to as usize] *= -1.0;
            }
            for k in self.starts[to as usize]..self.starts[to as usize + 1] {
                let next = self.neighbours[k as usize];
                if !done[next as usize] {
                    heap.push(Reverse((self.cost(to, next), to, next)));
                }
            }
        }
    }
}

/// The planes with a side for each. All must be given, since a side may come from far away.
pub fn orient(grid: &Grid, planes: &BTreeMap<BlockKey, Vec<Plane>>) -> BTreeMap<BlockKey, Vec<Plane>> {
    let mut graph = Graph::new(grid, planes);
    let mut done = vec![false; graph.normals.len()];
    let sided = planes.values().flatten().zip(0u32..).filter(|(plane, _)| plane.sided);
    let mut heap: BinaryHeap<Edge> = sided.map(|(_, index)| Reverse((0, index, index))).collect();
    graph.grow(&mut done, &mut heap);

    let mut downwards: Vec<u32> = (0..graph.normals.len() as u32).collect();
    downwards.sort_by(|&a, &b| graph.positions[b as usize].z.total_cmp(&graph.positions[a as usize].z).then(a.cmp(&b)));
    for root in downwards {
        if !done[root as usize] {
            if graph.normals[root as usize].z < 0.0 {
                graph.normals[root as usize] *= -1.0;
            }
            heap.push(Reverse((0, root, root)));
            graph.grow(&mut done, &mut heap);
        }
    }
    let mut normals = graph.normals.into_iter();
    let mut oriented = planes.clone();
    for (plane, normal) in oriented.values_mut().flatten().zip(&mut normals) {
        plane.normal = normal;
    }
    oriented
}
