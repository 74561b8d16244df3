//! How dense and how noisy the cloud is, and the radius that follows.

use crate::grid::KeyHash;
use crate::plane::{Plane, planes};
use crate::quadric::quadrics;
use crate::sample::Sample;
use crate::surfel::Surfel;
use crate::{Config, grid::Grid};
use nalgebra::Vector3;
use rayon::prelude::*;
use std::collections::HashMap;

/// What the cloud is like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Square root of the area that falls to one sample, in metres.
    pub spacing_m: f64,
    /// Standard deviation of the samples from a local quadric, in metres.
    pub noise_m: f64,
    /// Median of the variances that samples state, in square metres; 1 where none does.
    pub typical_variance: f32,
}

type Voxel = [i32; 3];

/// The density is counted over so many samples, chosen by a hash of their ids.
const COUNTED: usize = 20_000;
/// Density and noise are looked at around so many of these.
const PROBES: usize = 500;
/// A voxel of the count should hold this many samples.
const PER_VOXEL: std::ops::Range<usize> = 8..32;
/// The noise is measured over a neighbourhood of this many spacings.
const NOISE_SPACINGS: f64 = 4.0;
/// The radius over the spacing, for the noise over the spacing x: 8 sqrt(x), but never fewer samples than a quadric
/// needs, nor a neighbourhood so wide that no shape is left in it.
const RADIUS_PER_ROOT: f64 = 8.0;
const RADIUS_SPACINGS: [f64; 2] = [3.0, 12.0];
/// Radii come in steps of this ratio, so that a growing cloud keeps its grid.
const RADIUS_STEP: f64 = 1.12;

fn voxel(p: &Vector3<f32>, edge_m: f64) -> Voxel {
    [0, 1, 2].map(|axis| (f64::from(p[axis]) / edge_m).floor() as i32)
}

fn neighbours(v: Voxel) -> impl Iterator<Item = Voxel> {
    crate::grid::around(v)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// A fixed shuffle of ids (Steele, Lea and Flood's finaliser), so that neither stripes nor rows bias the choice.
fn shuffled(id: u32) -> u64 {
    let z = (u64::from(id) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z ^ (z >> 31)
}

impl Scale {
    /// Looks at the cloud; `None` when it has no two places. `samples` in the order of their ids.
    pub fn of(samples: &[Sample]) -> Option<Self> {
        let one_in = samples.len().div_ceil(COUNTED).max(1);
        let counted: Vec<&Sample> = samples.iter().filter(|s| shuffled(s.id).is_multiple_of(one_in as u64)).collect();
        let share = counted.len() as f64 / samples.len() as f64;
        let spacing_m = spacing(&counted)? * share.sqrt();
        let probes: Vec<&Sample> = counted.iter().copied().step_by(counted.len().div_ceil(PROBES).max(1)).collect();
        let stated = samples.iter().step_by(one_in).filter(|s| s.sigma_m > 0.0).map(|s| f64::from(s.sigma_m).powi(2));
        // In powers of two, so that a growing cloud keeps its weights.
        let typical_variance = median(stated.collect()).map_or(1.0, |v| v.log2().round().exp2()) as f32;
        Some(Self { spacing_m, noise_m: noise(samples, &probes, spacing_m), typical_variance })
    }

    /// The radius for this cloud, in metres.
    pub fn radius_m(&self) -> f64 {
        let [least, most] = RADIUS_SPACINGS;
        let spacings = (RADIUS_PER_ROOT * (self.noise_m / self.spacing_m).sqrt()).clamp(least, most);
        let steps = (spacings * self.spacing_m).ln() / RADIUS_STEP.ln();
        RADIUS_STEP.powf(steps.round())
    }

    /// The grid for this cloud and what the user chose of it.
    pub fn grid(&self, config: &Config) -> Grid {
        Grid::new(config.radius_m().unwrap_or_else(|| self.radius_m()), config.cell_m())
    }
}

fn count(samples: &[&Sample], edge_m: f64) -> HashMap<Voxel, Vec<u32>, KeyHash> {
    let mut voxels: HashMap<Voxel, Vec<u32>, KeyHash> = HashMap::default();
    for (index, sample) in samples.iter().enumerate() {
        voxels.entry(voxel(&sample.position, edge_m)).or_default().push(index as u32);
    }
    voxels
}

/// Median over the samples of 1/sqrt(density), the density counted in a disc of a fitting radius.
fn spacing(samples: &[&Sample]) -> Option<f64> {
    let first = samples.first()?.position;
    let extent = samples.iter().map(|s| f64::from((s.position - first).amax())).fold(0.0, f64::max);
    if extent <= 0.0 {
        return None;
    }
    let mut edge_m = extent / 64.0;
    let mut voxels = count(samples, edge_m);
    // Halving or doubling finds a fitting edge; outliers may have made the extent a thousand times too large.
    for _ in 0..16 {
        let occupied = |v: &Vec<u32>| std::iter::repeat_n(v.len() as f64, v.len());
        let typical = median(voxels.values().flat_map(occupied).collect())? as usize;
        if PER_VOXEL.contains(&typical) || (typical < PER_VOXEL.start && edge_m >= extent) {
            break;
        }
        edge_m *= if typical < PER_VOXEL.start { 1.6 } else { 0.6 };
        voxels = count(samples, edge_m);
    }
    let densities = samples.iter().step_by(samples.len().div_ceil(PROBES)).map(|s| {
        let near = neighbours(voxel(&s.position, edge_m)).filter_map(|v| voxels.get(&v)).flatten();
        let within = |&&i: &&u32| f64::from((samples[i as usize].position - s.position).norm()) < edge_m;
        // The probe itself is there for certain and says nothing of the density.
        (near.filter(within).count() as f64 - 1.0).max(0.5) / (std::f64::consts::PI * edge_m * edge_m)
    });
    median(densities.collect()).map(|density| 1.0 / density.sqrt())
}

/// Median over the probes of how far the samples stand from a quadric fitted to them.
fn noise(samples: &[Sample], probes: &[&Sample], spacing_m: f64) -> f64 {
    let radius_m = NOISE_SPACINGS * spacing_m;
    let mut near_probe: HashMap<Voxel, Vec<Surfel>, KeyHash> = HashMap::default();
    for probe in probes {
        for v in neighbours(voxel(&probe.position, radius_m)) {
            near_probe.entry(v).or_default();
        }
    }
    for sample in samples {
        if let Some(near) = near_probe.get_mut(&voxel(&sample.position, radius_m)) {
            near.push(Surfel { position: sample.position, seen: sample.seen, weight: 1.0, variance: 0.0 });
        }
    }
    let deviation = |probe: &&Sample| {
        let radius_squared = (radius_m * radius_m) as f32;
        let mut near: Vec<Surfel> = neighbours(voxel(&probe.position, radius_m))
            .filter_map(|v| near_probe.get(&v))
            .flatten()
            .filter(|s| (s.position - probe.position).norm_squared() < radius_squared && s.seen.dot(&probe.seen) >= 0.0)
            .copied()
            .collect();
        near.truncate(256);
        residual(&near, probe, radius_m as f32)
    };
    median(probes.par_iter().filter_map(deviation).collect()).unwrap_or(0.0)
}

/// Standard deviation of a neighbourhood from its own quadric.
fn residual(near: &[Surfel], probe: &Sample, radius_m: f32) -> Option<f64> {
    const COEFFICIENTS: usize = 6;
    let centre = Surfel { position: probe.position, seen: probe.seen, weight: 1.0, variance: 0.0 };
    let grid = Grid::new(f64::from(radius_m), None);
    let plane = *planes(&grid, &[centre], near).first()?;
    let sided: Vec<Plane> = near.iter().map(|s| Plane { position: s.position, ..plane }).collect();
    let quadric = *quadrics(&[plane], &sided).first()?;
    let squares: f64 = near.iter().map(|s| f64::from(quadric.distance(&(s.position - quadric.centre))).powi(2)).sum();
    let free = near.len().checked_sub(COEFFICIENTS).filter(|&free| free > 0)?;
    Some((squares / free as f64).sqrt())
}
