//! The wiring: changes of the cloud come, the surface goes once in a while, and the clean one at the end.

use crate::{Config, Surfer};
use kit::{Node, STREAM_HISTORY};
use std::time::{Duration, Instant};
use wire::{Header, Phase, topic};

/// Keeps the surface of the cloud until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    let live_every = Duration::from_secs_f64(config.live_every_s);
    let mut surfer = Surfer::new(config)?;
    let mut clouds = node.input(&topic::cloud(), STREAM_HISTORY)?;
    let mut meshes = node.output(&topic::mesh())?;
    node.ready()?;
    let (mut published, mut changed) = (Instant::now(), false);
    while node.wait() {
        while let Some(cloud) = clouds.next() {
            surfer.update(&cloud);
            changed = true;
            if cloud.header.is_end() {
                let started = Instant::now();
                let mesh = surfer.final_mesh();
                let triangles = mesh.triangles.len();
                tracing::info!("{triangles} triangles over {} balls in {:.2?}", surfer.samples(), started.elapsed());
                surfer.refused().iter().for_each(|refusal| node.refuse(&refusal.reason, refusal.count));
                meshes.send(wire::Mesh { header: Header { phase: Phase::End, ..cloud.header.derived() }, ..mesh })?;
                changed = false;
            }
            node.finished(&cloud.header)?;
        }
        // The live surface is for the eye: it waits until nothing else is to do.
        if changed && !live_every.is_zero() && published.elapsed() >= live_every {
            meshes.send(surfer.live_mesh())?;
            (published, changed) = (Instant::now(), false);
        }
    }
    node.close()
}
