//! How far one surface lies from another, both ways, measured to triangles and not to vertices.

use crate::{MeshError, MeshIndex, SurfaceSample, TriangleMesh};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// How many points are spread over each surface (an estimated 95 % quantile of so many is good to 0.1 % of rank).
pub const COMPARE_SAMPLES: usize = 200_000;
/// The distances for which a comparison tells the share of the truth that is that close.
pub const WITHIN_MM: [f64; 4] = [0.25, 0.5, 1.0, 2.0];

const MM_PER_METRE: f64 = 1e3;

/// Two surfaces compared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// From points of the model to the truth: is it right?
    pub model_to_truth: Distances,
    /// From points of the truth to the model: is it complete?
    pub truth_to_model: Completeness,
    /// The same for those points of the truth that the camera could see, when that is known.
    pub seen_truth_to_model: Option<Completeness>,
    /// The seed of the points.
    pub seed: u64,
    /// Each model point's distance, positive outside the truth: for a histogram.
    #[serde(skip)]
    pub signed_mm: Vec<f32>,
}

/// Distances of points that are spread evenly over a surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Distances {
    /// How many points.
    pub samples: usize,
    /// Root mean square.
    pub rms_mm: f64,
    /// Half of the surface is closer.
    pub median_mm: f64,
    /// 95 % of the surface are closer.
    pub p95_mm: f64,
    /// The farthest point.
    pub max_mm: f64,
    /// Mean of the signed distances, positive outside: zero unless the model is too thick or too thin.
    pub bias_mm: f64,
}

/// How much of a surface has the other one near it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Completeness {
    /// How many points.
    pub samples: usize,
    /// For each of [`WITHIN_MM`], the share of points at most that far, 0..1.
    pub within: Vec<Within>,
}

/// A share of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Within {
    /// At most this far.
    pub distance_mm: f64,
    /// 0..1.
    pub share: f64,
}

impl Completeness {
    /// The share at most this far, if it was asked for.
    pub fn share_within_mm(&self, distance_mm: f64) -> Option<f64> {
        self.within.iter().find(|w| w.distance_mm == distance_mm).map(|w| w.share)
    }
}

/// Why two surfaces cannot be compared.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CompareError {
    /// The one that was made.
    #[error("the model cannot be compared: {0}")]
    Model(MeshError),
    /// The one that is true.
    #[error("the truth cannot be compared with: {0}")]
    Truth(MeshError),
    /// All triangles are degenerate.
    #[error("the {0} has no area")]
    NoArea(&'static str),
    /// The mask belongs to other samples.
    #[error("{mask} marks of what could be seen for {samples} points of the truth")]
    Mask {
        /// How many marks came.
        mask: usize,
        /// How many points there are.
        samples: usize,
    },
}

/// The points of the truth that [`compare`] measures from, in its order: for the mask of what could be seen.
pub fn truth_samples(truth: &TriangleMesh, seed: u64) -> Result<Vec<SurfaceSample>, CompareError> {
    crate::sample_surface(truth, COMPARE_SAMPLES, seed).map_err(CompareError::Truth)
}

/// Compares a model with the truth, in both directions, at [`COMPARE_SAMPLES`] points each. `seen` tells for each of
/// [`truth_samples`] whether the scan had a chance to see it. The same seed gives the same result on any number of
/// threads. The sign of a distance is the side of the closest triangle of the truth that the point lies on.
pub fn compare(
    model: &TriangleMesh,
    truth: &TriangleMesh,
    seen: Option<&[bool]>,
    seed: u64,
) -> Result<Comparison, CompareError> {
    let model = MeshIndex::new(model).map_err(CompareError::Model)?;
    let truth = MeshIndex::new(truth).map_err(CompareError::Truth)?;
    let on_model = samples_of(&model, "model", seed)?;
    let on_truth = samples_of(&truth, "truth", seed)?;
    if let Some(mask) = seen.map(<[bool]>::len).filter(|&mask| mask != on_truth.len()) {
        return Err(CompareError::Mask { mask, samples: on_truth.len() });
    }
    let signed_mm: Vec<f64> = on_model.par_iter().map(|s| signed_mm(&truth, s)).collect();
    let to_model: Vec<f64> = on_truth.par_iter().map(|s| distance_mm(&model, s)).collect();
    let seen_truth_to_model = seen.map(|mask| {
        let reachable = to_model.iter().zip(mask).filter(|(_, seen)| **seen);
        completeness(reachable.map(|(distance, _)| *distance).collect())
    });
    Ok(Comparison {
        model_to_truth: distances(&signed_mm),
        truth_to_model: completeness(to_model),
        seen_truth_to_model,
        seed,
        signed_mm: signed_mm.iter().map(|&d| d as f32).collect(),
    })
}

/// The one direction of [`compare`] alone: from the model to the truth.
pub fn distances_to(model: &TriangleMesh, truth: &TriangleMesh, seed: u64) -> Result<Distances, CompareError> {
    let model = MeshIndex::new(model).map_err(CompareError::Model)?;
    let truth = MeshIndex::new(truth).map_err(CompareError::Truth)?;
    let on_model = samples_of(&model, "model", seed)?;
    let signed_mm: Vec<f64> = on_model.par_iter().map(|s| signed_mm(&truth, s)).collect();
    Ok(distances(&signed_mm))
}

fn samples_of(mesh: &MeshIndex, name: &'static str, seed: u64) -> Result<Vec<SurfaceSample>, CompareError> {
    let samples = mesh.sample(COMPARE_SAMPLES, seed);
    if samples.is_empty() { Err(CompareError::NoArea(name)) } else { Ok(samples) }
}

fn distance_mm(other: &MeshIndex, sample: &SurfaceSample) -> f64 {
    other.closest(&sample.point).map_or(f64::NAN, |c| c.distance * MM_PER_METRE)
}

fn signed_mm(truth: &MeshIndex, sample: &SurfaceSample) -> f64 {
    truth.signed_distance(&sample.point).map_or(f64::NAN, |d| d * MM_PER_METRE)
}

impl MeshIndex {
    /// The distance to the mesh, negative behind the closest triangle; `None` only for a point that is not finite.
    pub fn signed_distance(&self, point: &nalgebra::Point3<f64>) -> Option<f64> {
        let closest = self.closest(point)?;
        let behind = self.normal(closest.triangle).dot(&(point - closest.point)) < 0.0;
        Some(if behind { -closest.distance } else { closest.distance })
    }
}

fn distances(signed_mm: &[f64]) -> Distances {
    let count = signed_mm.len() as f64;
    let mut sorted: Vec<f64> = signed_mm.iter().map(|d| d.abs()).collect();
    sorted.par_sort_unstable_by(f64::total_cmp);
    let quantile = |q: f64| sorted[(((sorted.len() - 1) as f64) * q).round() as usize];
    Distances {
        samples: sorted.len(),
        rms_mm: (signed_mm.iter().map(|d| d * d).sum::<f64>() / count).sqrt(),
        median_mm: quantile(0.5),
        p95_mm: quantile(0.95),
        max_mm: quantile(1.0),
        bias_mm: signed_mm.iter().sum::<f64>() / count,
    }
}

fn completeness(distances_mm: Vec<f64>) -> Completeness {
    let samples = distances_mm.len();
    let share = |limit: f64| {
        let near = distances_mm.iter().filter(|d| **d <= limit).count();
        near as f64 / samples.max(1) as f64
    };
    let within = WITHIN_MM.iter().map(|&distance_mm| Within { distance_mm, share: share(distance_mm) }).collect();
    Completeness { samples, within }
}
