//! What one scan brought.

use crate::accounts::Accounts;
use std::collections::BTreeMap;
use std::time::Instant;
use wire::{CloudPoint, Mesh, Model, Refinement, Scan, TrajectorySample};

/// Gathered from the bus.
#[derive(Default)]
pub struct Harvest {
    /// What every node has told of itself.
    pub accounts: Accounts,
    /// When each node (kind/instance) had finished.
    pub finished: BTreeMap<String, Instant>,
    /// When the first measurement came.
    pub began: Option<Instant>,
    /// Registered points.
    pub points: u64,
    /// What register made of the scan, where something better came of it.
    pub placed: Vec<Scan>,
    /// What refinement says of itself.
    pub refinement: Option<Refinement>,
    /// The balls of the final cloud.
    pub cloud: Vec<CloudPoint>,
    /// The true way of the camera, when the world is known.
    pub truth: Vec<TrajectorySample>,
    /// The final surface, as far as it was measured.
    pub mesh: Option<Mesh>,
    /// The same with the caps that close it.
    pub closed: Option<Mesh>,
    /// The final model.
    pub model: Option<Model>,
}

impl Harvest {
    /// Seconds between two moments of the run; `None` unless both came.
    pub fn seconds(&self, from: Option<Instant>, to: Option<Instant>) -> Option<f64> {
        Some(to?.saturating_duration_since(from?).as_secs_f64())
    }
}
