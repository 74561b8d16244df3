//! Samples gathered into voxels, so that the work depends on the surface's area and not on the number of samples.

use crate::grid::{BlockKey, Grid, VOXELS};
use crate::sample::Sample;
use nalgebra::Vector3;

/// The mean of the samples of one voxel that were seen from one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surfel {
    /// Weighted mean, in the world.
    pub position: Vector3<f32>,
    /// Unit vector to the side from which it was seen, or zero.
    pub seen: Vector3<f32>,
    /// Sum of the samples' weights; a sample of typical sigma weighs 1.
    pub weight: f32,
    /// Variance of the mean along the normal, as the samples state it; 0 when they do not.
    pub variance: f32,
}

/// Sums over samples, turned into a surfel at the end.
#[derive(Clone, Copy)]
struct Sum {
    first_seen: Vector3<f32>,
    position: Vector3<f32>,
    seen: Vector3<f32>,
    weight: f32,
    variance: f32,
}

impl Sum {
    fn new(seen: Vector3<f32>) -> Self {
        Self { first_seen: seen, position: Vector3::zeros(), seen: Vector3::zeros(), weight: 0.0, variance: 0.0 }
    }

    fn add(&mut self, sample: &Sample, offset: Vector3<f32>, weight: f32) {
        self.position += offset * weight;
        self.seen += sample.seen * weight;
        self.weight += weight;
        self.variance += (weight * sample.sigma_m).powi(2);
    }

    fn surfel(&self, origin: &Vector3<f32>) -> Surfel {
        Surfel {
            position: origin + self.position / self.weight,
            seen: self.seen.try_normalize(0.0).unwrap_or_else(Vector3::zeros),
            weight: self.weight,
            variance: self.variance / (self.weight * self.weight),
        }
    }
}

/// How much a sample counts: one over its variance, bounded by adding the typical one; 1 when its sigma is not known.
fn weight(sigma_m: f32, typical_variance: f32) -> f32 {
    let variance = sigma_m * sigma_m;
    if variance > 0.0 { 2.0 * typical_variance / (variance + typical_variance) } else { 1.0 }
}

/// The surfels of one block. `samples` are those of the block, in the order of their ids.
pub fn surfels(grid: &Grid, key: BlockKey, samples: &[&Sample], typical_variance: f32) -> Vec<Surfel> {
    const EMPTY: u16 = u16::MAX;
    // Two sides of a thin sheet may share a voxel: one place for each.
    let mut place = [[EMPTY; 2]; VOXELS * VOXELS * VOXELS];
    let mut sums: Vec<Sum> = Vec::new();
    let origin = grid.origin(key);
    for sample in samples {
        let offset = sample.position - origin;
        let [x, y, z] = [0, 1, 2].map(|axis| ((offset[axis] / grid.voxel_m()) as usize).min(VOXELS - 1));
        let voxel = &mut place[(x * VOXELS + y) * VOXELS + z];
        let opposite = voxel[0] != EMPTY && sums[voxel[0] as usize].first_seen.dot(&sample.seen) < 0.0;
        let slot = &mut voxel[usize::from(opposite)];
        if *slot == EMPTY {
            *slot = sums.len() as u16;
            sums.push(Sum::new(sample.seen));
        }
        sums[*slot as usize].add(sample, offset, weight(sample.sigma_m, typical_variance));
    }
    sums.iter().map(|sum| sum.surfel(&origin)).collect()
}
