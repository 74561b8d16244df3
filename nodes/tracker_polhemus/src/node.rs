//! The wiring: records of the tracker as they come, poses out.

use crate::port::Polhemus;
use crate::{Config, PolhemusTracker};
use kit::Node;
use serial_line::node::Source;

/// Sends the poses of one scan after the other until it is told to stop.
pub fn run(node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    let tracker = PolhemusTracker::new(config.clone())?;
    let (sensors, scan_clock) = (config.stations.clone(), config.scan_clock);
    let device = Polhemus::new(config);
    let line = device.line_settings();
    serial_line::node::run(node, Source { tracker, device, line, sensors, scan_clock })
}
