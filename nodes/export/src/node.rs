//! The wiring: the final cloud, surface and model come, and files are written.

use crate::{Config, ExportError, Exporter, Written};
use kit::{Node, STREAM_HISTORY};
use wire::topic;

/// Writes the files of every scan until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    let mut exporter = Exporter::new(config)?;
    let mut clouds = node.input(&topic::cloud(), STREAM_HISTORY)?;
    let mut meshes = node.input(&topic::mesh(), 4)?;
    let mut models = node.input(&topic::textured(), 2)?;
    node.ready()?;
    while node.wait() {
        while let Some(cloud) = clouds.next() {
            tell(&mut node, exporter.cloud(&cloud));
        }
        while let Some(mesh) = meshes.next() {
            tell(&mut node, exporter.mesh(&mesh));
        }
        while let Some(model) = models.next() {
            tell(&mut node, exporter.model(&model));
            // The model is the last of a scan.
            if model.header.is_end() {
                node.finished(&model.header)?;
            }
        }
    }
    node.close()
}

/// What could not be written is said and counted; the rest is written all the same.
fn tell(node: &mut Node, outcome: Result<Vec<Written>, ExportError>) {
    match outcome {
        Ok(files) => files.iter().for_each(|file| tracing::info!("{file}")),
        Err(error) => {
            tracing::error!("{error}");
            node.refuse("file that could not be written", 1);
        }
    }
}
