//! The sparse grid: space cut into cubic blocks, of which only those near a sample exist.

use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Which block: x, y, z in units of the block's edge. Its order is the order of all that is summed.
pub type BlockKey = [i32; 3];

/// How the world is divided. A block's edge is 8/3 of the radius, so all that lies within twice the radius of a block
/// is found in it and its 26 neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Edge of a block, in metres.
    pub block_m: f32,
    /// Cells of the marching cubes along it.
    pub cells: usize,
    /// Radius of the neighbourhoods, in metres.
    pub radius_m: f32,
}

/// Edges of the voxels into which samples are gathered, along a block.
pub const VOXELS: usize = 8;
/// Voxel edges in a radius.
const RADIUS_VOXELS: f64 = 3.0;
const FEWEST_CELLS: f64 = 6.0;
const MOST_CELLS: f64 = 64.0;

impl Grid {
    /// The grid for a radius. With a cell given, the radius yields by what makes a block a whole number of cells.
    pub fn new(radius_m: f64, cell_m: Option<f64>) -> Self {
        let per_radius = VOXELS as f64 / RADIUS_VOXELS;
        let Some(cell_m) = cell_m else {
            return Self { block_m: (per_radius * radius_m) as f32, cells: VOXELS, radius_m: radius_m as f32 };
        };
        let cells = (per_radius * radius_m / cell_m).round().clamp(FEWEST_CELLS, MOST_CELLS);
        let block_m = cells * cell_m;
        Self { block_m: block_m as f32, cells: cells as usize, radius_m: (block_m / per_radius) as f32 }
    }

    /// Edge of a cell of the marching cubes, in metres.
    pub fn cell_m(&self) -> f32 {
        self.block_m / self.cells as f32
    }

    /// Edge of a voxel, in metres.
    pub fn voxel_m(&self) -> f32 {
        self.block_m / VOXELS as f32
    }

    /// The block around a point.
    pub fn key(&self, p: &Vector3<f32>) -> BlockKey {
        [0, 1, 2].map(|axis| (p[axis] / self.block_m).floor() as i32)
    }

    /// The smallest corner of a block.
    pub fn origin(&self, key: BlockKey) -> Vector3<f32> {
        Vector3::from(key.map(|k| k as f32)) * self.block_m
    }

    /// A corner of the marching cubes, by its place counted from a block's origin. Neighbouring blocks must agree on a
    /// shared corner to the last bit, so it is computed from its number in the world.
    pub fn corner(&self, key: BlockKey, place: [usize; 3]) -> Vector3<f32> {
        let cell = self.cell_m();
        Vector3::from([0, 1, 2].map(|axis| self.corner_number(key, place, axis) as f32 * cell))
    }

    /// The number of a corner along one axis of the world.
    pub fn corner_number(&self, key: BlockKey, place: [usize; 3], axis: usize) -> i64 {
        i64::from(key[axis]) * self.cells as i64 + place[axis] as i64
    }

    /// Squared distance of a point from a block.
    pub fn distance_squared(&self, key: BlockKey, p: &Vector3<f32>) -> f32 {
        let low = self.origin(key);
        let outside = |axis: usize| (low[axis] - p[axis]).max(p[axis] - low[axis] - self.block_m).max(0.0);
        (0..3).map(|axis| outside(axis).powi(2)).sum()
    }
}

/// A block and its 26 neighbours, in the order of their keys.
pub fn around(key: BlockKey) -> impl Iterator<Item = BlockKey> {
    (0..27).map(move |n| [key[0] + n / 9 - 1, key[1] + n / 3 % 3 - 1, key[2] + n % 3 - 1])
}

/// Copies from a block and its neighbours what `select` finds in them, in the order of the keys.
pub fn gather<B, T: Copy>(
    blocks: &BTreeMap<BlockKey, B>,
    key: BlockKey,
    items: impl Fn(&B) -> &[T],
    near: impl Fn(&T) -> bool,
) -> Vec<T> {
    let mut found = Vec::new();
    for block in around(key).filter_map(|neighbour| blocks.get(&neighbour)) {
        found.extend(items(block).iter().copied().filter(&near));
    }
    found
}

/// A quick hash for keys that nobody chose to be hostile; nothing depends on the order it gives.
#[derive(Default)]
pub struct KeyHasher(u64);

/// For maps keyed by numbers.
pub type KeyHash = BuildHasherDefault<KeyHasher>;

impl Hasher for KeyHasher {
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(u64::from(byte));
        }
    }
    fn write_u64(&mut self, value: u64) {
        // The multiplier of Steele, Lea & Flood's splitmix; the rotation carries high bits down between words.
        self.0 = (self.0.rotate_left(23) ^ value).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
    fn write_u32(&mut self, value: u32) {
        self.write_u64(u64::from(value));
    }
    fn write_i32(&mut self, value: i32) {
        self.write_u64(value as u64);
    }
    fn write_usize(&mut self, value: usize) {
        self.write_u64(value as u64);
    }
}
