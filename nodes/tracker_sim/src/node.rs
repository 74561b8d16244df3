//! The wiring: readings of the simulated tracker, in their time.

use crate::{Config, TrackerSim};
use kit::Node;
use wire::{Header, Phase, Pose, topic};

/// Sends the readings of one scan after the other until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let Config { setup, receiver } = node.spec().config()?;
    let known = setup.open()?;
    let mut poses = node.output(&topic::pose(node.instance()))?;
    let (scene, rig, seconds) = (&known.scene, &known.rig, setup.seconds);
    let readings = match receiver {
        None => TrackerSim::new(scene, rig, seconds, known.seed)?,
        Some(place) => TrackerSim::receiver(scene, rig, seconds, known.seed, &place, node.instance())?,
    };
    node.ready()?;
    let mut scanned = None;
    while let Some(go) = node.wait_for_go(scanned)? {
        scanned = Some(go.scan);
        let mut last = 0;
        for mut pose in readings.clone() {
            last = pose.header.stamp_nanos;
            if !node.wait_for_turn(&go, last) {
                break;
            }
            pose.header.scan = go.scan;
            let header = pose.header;
            poses.send(pose)?;
            node.finished(&header)?;
        }
        let header = Header { scan: go.scan, phase: Phase::End, stamp_nanos: last + 1, ..Header::default() };
        poses.send(Pose::none(header, "the scan has ended"))?;
        node.finished(&header)?;
    }
    node.close()
}
