//! The wiring: the operator's phase comes, the lights are switched.

use crate::{Config, Lights};
use kit::Node;
use serial_line::node::tell;
use wire::Phase;

/// Keeps the lights as the phase wants them until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    config.check()?;
    let lights = Lights::start(config, tell);
    node.ready()?;
    let mut phase = Phase::End;
    while node.wait() {
        let now = node.phase().map_or(Phase::Aim, |run| run.header.phase);
        if now != phase {
            phase = now;
            lights.begin(phase);
        }
    }
    // They go out before the node leaves.
    drop(lights);
    node.close()
}
