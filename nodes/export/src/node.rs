//! The wiring: the final cloud, surface and model come, and files are written.

use crate::{Config, Exporter};
use kit::Node;
use wire::{Cloud, Header, Mesh, Model, topic};

/// Writes the files of every scan until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    let exporter = Exporter::new(config)?;
    let mut clouds = node.input(&topic::cloud(), 4096)?;
    let mut meshes = node.input(&topic::mesh(), 4)?;
    let mut models = node.input(&topic::textured(), 2)?;
    node.ready()?;
    let (mut cloud, mut mesh, mut model): (Option<Cloud>, Option<Mesh>, Option<Model>) = (None, None, None);
    while node.wait() {
        while let Some(message) = clouds.next() {
            cloud = Some(message).filter(|cloud| cloud.header.is_end()).or(cloud);
        }
        while let Some(message) = meshes.next() {
            mesh = Some(message).filter(|mesh| mesh.header.is_end()).or(mesh);
        }
        while let Some(message) = models.next() {
            model = Some(message).filter(|model| model.header.is_end()).or(model);
        }
        let of = |header: Option<&Header>| header.map(|header| (header.scan, header.revision));
        let scans = [
            of(cloud.as_ref().map(|cloud| &cloud.header)),
            of(mesh.as_ref().map(|mesh| &mesh.header)),
            of(model.as_ref().map(|model| &model.header)),
        ];
        if scans[0] == scans[1]
            && scans[1] == scans[2]
            && let (Some(cloud), Some(mesh), Some(model)) = (cloud.take(), mesh.take(), model.take())
        {
            match exporter.write(&cloud, &mesh, &model) {
                Ok(files) => tracing::info!("written: {}", files.join(", ")),
                Err(error) => {
                    tracing::error!("{error}");
                    node.refuse("nothing to write", 1);
                }
            }
            node.finished(&model.header)?;
        }
    }
    node.close()
}
