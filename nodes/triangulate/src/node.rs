//! The wiring: a stripe comes, its profile goes.

use crate::{Config, Triangulator};
use kit::{Node, STREAM_HISTORY};
use wire::{Bulk, Profile, topic};

/// Triangulates every stripe of a camera until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    config.check()?;
    let mut stripes = node.stream(&topic::stripe(node.spec().source_of("camera")), STREAM_HISTORY)?;
    let mut profiles = node.output(&topic::profile(node.instance()))?;
    let rig = node.spec().source_of("rig").to_owned();
    let calibration = node.calibration(&rig)?;
    let mut triangulator = Triangulator::new(config, &calibration)?;
    node.ready()?;
    while node.wait() {
        while let Some(stripe) = stripes.next() {
            if stripe.header.is_end() {
                let header = stripe.header.derived();
                profiles.send(Profile { header, points: Bulk::default(), refused: Vec::new() })?;
            } else {
                // An unlit picture gives an empty profile: those behind learn that the scan has come so far.
                let profile = triangulator.process(&stripe);
                profile.refused.iter().for_each(|refusal| node.refuse(&refusal.reason, refusal.count));
                profiles.send(profile)?;
            }
            node.finished(&stripe.header)?;
        }
    }
    node.close()
}
