//! The surface as it grows: block by block, and only where something changed.
//!
//! Every step is a pure function of what lies within reach, so a block that is computed again from the same samples
//! comes out the same to the last bit: the order in which samples came, and the number of threads, do not show.

use crate::field::corners;
use crate::grid::{BlockKey, Grid, around, gather};
use crate::marching::{Patch, march};
use crate::orient::orient;
use crate::plane::{Plane, planes, within_reach};
use crate::quadric::{Quadric, quadrics};
use crate::sample::Sample;
use crate::surfel::{Surfel, surfels};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// All blocks, stage by stage. A block without entry has none of the stage.
#[derive(Debug, Clone)]
pub struct Model {
    grid: Grid,
    typical_variance: f32,
    /// Samples of each block, by their place in the store, in any order.
    members: BTreeMap<BlockKey, Vec<u32>>,
    surfels: BTreeMap<BlockKey, Vec<Surfel>>,
    planes: BTreeMap<BlockKey, Vec<Plane>>,
    /// The planes with a side for each; the same as `planes` when the cloud has normals.
    oriented: BTreeMap<BlockKey, Vec<Plane>>,
    quadrics: BTreeMap<BlockKey, Vec<Quadric>>,
    patches: BTreeMap<BlockKey, Patch>,
    changed: BTreeSet<BlockKey>,
}

impl Model {
    /// Nothing yet.
    pub fn new(grid: Grid, typical_variance: f32) -> Self {
        Self {
            grid,
            typical_variance,
            members: BTreeMap::new(),
            surfels: BTreeMap::new(),
            planes: BTreeMap::new(),
            oriented: BTreeMap::new(),
            quadrics: BTreeMap::new(),
            patches: BTreeMap::new(),
            changed: BTreeSet::new(),
        }
    }

    /// How the world is divided.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The typical variance that it was made with.
    pub fn typical_variance(&self) -> f32 {
        self.typical_variance
    }

    /// The surface of each block, as of the last `refresh`.
    pub fn patches(&self) -> &BTreeMap<BlockKey, Patch> {
        &self.patches
    }

    /// Takes a sample in; `place` is where it stands in the store.
    pub fn insert(&mut self, place: u32, sample: &Sample) {
        let key = self.grid.key(&sample.position);
        self.members.entry(key).or_default().push(place);
        self.changed.insert(key);
    }

    /// Takes the place of an older state of the same sample.
    pub fn replace(&mut self, place: u32, old: &Sample, new: &Sample) {
        let key = self.grid.key(&old.position);
        if key != self.grid.key(&new.position) {
            self.remove(place, old);
            self.insert(place, new);
        }
        self.changed.insert(key);
    }

    /// Takes a sample out.
    pub fn remove(&mut self, place: u32, sample: &Sample) {
        let key = self.grid.key(&sample.position);
        if let Some(members) = self.members.get_mut(&key) {
            members.retain(|&member| member != place);
        }
        self.changed.insert(key);
    }

    /// Computes again what the changes since the last time reach.
    pub fn refresh(&mut self, store: &[Sample]) {
        let changed = std::mem::take(&mut self.changed);
        if changed.is_empty() {
            return;
        }
        let Self { grid, typical_variance, members, .. } = self;
        let changed = update(&mut self.surfels, &changed, |key| {
            let mut samples: Vec<&Sample> =
                members.get(&key).into_iter().flatten().map(|&m| &store[m as usize]).collect();
            samples.sort_by_key(|sample| sample.id);
            surfels(grid, key, &samples, *typical_variance)
        });

        let own = |key| self.surfels.get(&key).map_or(&[][..], Vec::as_slice);
        let changed = update(&mut self.planes, &dilated(changed.keys()), |key| {
            let near = || gather(&self.surfels, key, Vec::as_slice, |s| within_reach(grid, key, &s.position));
            if own(key).is_empty() { Vec::new() } else { planes(grid, own(key), &near()) }
        });
        let changed = self.orient(changed);

        let (grid, oriented) = (&self.grid, &self.oriented);
        let own = |key| oriented.get(&key).map_or(&[][..], Vec::as_slice);
        let changed = update(&mut self.quadrics, &dilated(changed.keys()), |key| {
            let near = || gather(oriented, key, Vec::as_slice, |p| within_reach(grid, key, &p.position));
            if own(key).is_empty() { Vec::new() } else { quadrics(own(key), &near()) }
        });
        self.march(&reached(grid, &changed));
    }

    /// Brings `oriented` up to date; returns the blocks in which it changed.
    fn orient(&mut self, changed: Changed<Plane>) -> Changed<Plane> {
        if self.planes.values().flatten().all(|plane| plane.sided) {
            let keys = changed.into_keys().collect();
            return update(&mut self.oriented, &keys, |key| self.planes.get(&key).cloned().unwrap_or_default());
        }
        let all = orient(&self.grid, &self.planes);
        let keys = self.oriented.keys().chain(all.keys()).copied().collect();
        update(&mut self.oriented, &keys, |key| all.get(&key).cloned().unwrap_or_default())
    }

    fn march(&mut self, keys: &BTreeSet<BlockKey>) {
        let (grid, quadrics) = (&self.grid, &self.quadrics);
        let computed: Vec<(BlockKey, Patch)> = keys
            .par_iter()
            .map(|&key| {
                let reaches = |q: &Quadric| grid.distance_squared(key, &q.centre) < q.reach_m * q.reach_m;
                let near = gather(quadrics, key, Vec::as_slice, reaches);
                let empty = near.is_empty();
                (key, if empty { Patch::default() } else { march(grid, key, &corners(grid, key, &near), &near) })
            })
            .collect();
        for (key, patch) in computed {
            if patch.triangles.is_empty() {
                self.patches.remove(&key);
            } else {
                self.patches.insert(key, patch);
            }
        }
    }
}

/// What a stage held before and holds now in the blocks where that differs; what is the same in both is left out where
/// that is easily seen.
type Changed<T> = BTreeMap<BlockKey, Vec<T>>;

fn dilated<'a>(keys: impl Iterator<Item = &'a BlockKey>) -> BTreeSet<BlockKey> {
    keys.copied().flat_map(around).collect()
}

/// The blocks that changed quadrics reach.
fn reached(grid: &Grid, changed: &Changed<Quadric>) -> BTreeSet<BlockKey> {
    let reaches = |key, q: &Quadric| grid.distance_squared(key, &q.centre) < q.reach_m * q.reach_m;
    let mut keys = BTreeSet::new();
    for (&key, quadrics) in changed {
        keys.extend(around(key).filter(|&near| quadrics.iter().any(|q| reaches(near, q))));
    }
    keys
}

/// Computes some blocks of a stage again.
fn update<T: Copy + PartialEq + Send>(
    stage: &mut BTreeMap<BlockKey, Vec<T>>,
    keys: &BTreeSet<BlockKey>,
    compute: impl Fn(BlockKey) -> Vec<T> + Sync,
) -> Changed<T> {
    let computed: Vec<(BlockKey, Vec<T>)> = keys.par_iter().map(|&key| (key, compute(key))).collect();
    let mut changed = Changed::new();
    for (key, new) in computed {
        let old = stage.remove(&key).unwrap_or_default();
        if old != new {
            changed.insert(key, differing(&old, &new));
        }
        if !new.is_empty() {
            stage.insert(key, new);
        }
    }
    changed
}

fn differing<T: Copy + PartialEq>(old: &[T], new: &[T]) -> Vec<T> {
    if old.len() != new.len() {
        return [old, new].concat();
    }
    old.iter().zip(new).filter(|(a, b)| a != b).flat_map(|(a, b)| [*a, *b]).collect()
}
