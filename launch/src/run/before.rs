//! What the scan would be without refinement: the same balls and the same surface, over what `register` made of it. It is
//! there to be held against the truth, so nothing is guessed.

use crate::plan::Plan;
use anyhow::{Context as _, Result};
use cluster::BallClusterer;
use serde::de::DeserializeOwned;
use surface::Surfer;
use wire::{Mesh, Scan};

/// The surface through these scans, with the plan's own settings for both steps.
pub fn surface(plan: &Plan, scans: &[Scan]) -> Result<Mesh> {
    let mut clusterer = BallClusterer::new(config(plan, "cluster")?)?;
    scans.iter().for_each(|scan| clusterer.insert(scan));
    let settings: surface::Config = config(plan, "surface")?;
    let mut surfer = Surfer::new(surface::Config { close: false, ..settings })?;
    surfer.update(&clusterer.whole());
    Ok(surfer.final_mesh())
}

/// The effective configuration of the plan's only node of a kind.
pub fn config<C: DeserializeOwned>(plan: &Plan, kind: &str) -> Result<C> {
    let node = plan.nodes.iter().find(|node| node.kind == kind).with_context(|| format!("no node {kind}"))?;
    Ok(C::deserialize(&node.config)?)
}
