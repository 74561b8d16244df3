//! `limn scan shape|colour|both|end|discard`.

use crate::live::{WhichRig, print};
use crate::operator::Order;
use anyhow::{Result, bail};
use std::time::{Duration, Instant};
use wire::topic;

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn scan both       begin a scan, laser and lamp in turn
  limn scan shape      the laser only
  limn scan colour     go on with the lamp only
  limn scan end        the scan is complete: make the model
  limn scan discard    throw away what this scan has gathered";

/// How long the launcher may take to answer.
const ANSWER: Duration = Duration::from_secs(5);

/// Sends the order and waits until the launcher has published what follows from it.
pub fn run(order: Order, rig: &WhichRig) -> Result<()> {
    let (running, bus) = rig.open()?;
    let mut phases = bus.subscribe(&topic::run_phase(), 16)?;
    let deadline = Instant::now() + ANSWER;
    let mut wait = || {
        while Instant::now() < deadline {
            if let Some(phase) = phases.next() {
                return Ok(phase);
            }
            bus.wait(Duration::from_millis(100));
        }
        bail!("the launcher of rig {:?} does not answer", running.name)
    };
    let before = wait()?;
    let wanted = order.to_wire();
    bus.publisher(&topic::order())?.send(wanted.clone())?;
    let mut now = before;
    while (now.header.phase, now.discard) != (wanted.header.phase, wanted.discard) {
        now = match wait() {
            Ok(phase) => phase,
            Err(_) if order == Order::End => bail!("no scan is running in rig {:?}", running.name),
            Err(error) => return Err(error),
        };
    }
    print(&format!("rig {}, scan {}: {:?}\n", running.name, now.header.scan, now.header.phase))
}
