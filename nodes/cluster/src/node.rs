//! The wiring: scans come, what changed of the cloud goes a few times a second, and all of it at the end.

use crate::{BallClusterer, Config};
use kit::{Node, STREAM_HISTORY};
use wire::{Header, Phase, topic};

/// Clusters the scans of one world until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    let every_nanos = (config.publish_every_s * 1e9) as i64;
    let mut clusterer = BallClusterer::new(config)?;
    let mut scans = node.stream(&topic::scan(node.spec().source_of("world")), STREAM_HISTORY)?;
    let mut clouds = node.output(&topic::cloud())?;
    node.ready()?;
    let mut published_nanos = 0;
    while node.wait() {
        while let Some(scan) = scans.next() {
            clusterer.insert(&scan);
            if scan.header.is_end() {
                let mut whole = clusterer.whole();
                whole.header = Header { phase: Phase::End, ..whole.header };
                whole.refused.iter().for_each(|refusal| node.refuse(&refusal.reason, refusal.count));
                tracing::info!("{} balls of {} points", whole.points.len(), clusterer.held().points);
                if clusterer.held().points == 0 {
                    tracing::warn!("the scan is empty: not one point has come");
                }
                clouds.send(whole)?;
                published_nanos = 0;
            } else if scan.header.stamp_nanos >= published_nanos + every_nanos {
                published_nanos = scan.header.stamp_nanos;
                clouds.send(clusterer.changes())?;
            }
            node.finished(&scan.header)?;
        }
    }
    node.close()
}
