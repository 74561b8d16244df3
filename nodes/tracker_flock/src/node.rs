//! The wiring: records of the flock as they come, poses out.

use crate::port::Flock;
use crate::{Config, FlockTracker, Heard, SensorPose};
use anyhow::Context as _;
use kit::{Go, Node, Output};
use serial_line::{HostClock, News, Session};
use std::time::Duration;
use wire::{Clock, Header, Phase, Pose, topic};

/// How long the line may be quiet before the operator is listened to.
const NAP: Duration = Duration::from_millis(20);

/// Sends the poses of one scan after the other until it is told to stop. The first sensor's go to `tracker/<instance>`,
/// those of others to `tracker/<instance>_<address>`.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    let mut tracker = FlockTracker::new(config.clone())?;
    let mut outputs = Vec::new();
    for (sensor, address) in config.addresses().into_iter().enumerate() {
        let instance = node.instance().to_owned();
        let name = if sensor == 0 { instance } else { format!("{instance}_{address}") };
        outputs.push(node.output(&topic::pose(&name)).with_context(|| format!("poses of unit {address}"))?);
    }
    let clock = HostClock::start();
    let flock = Flock::new(config);
    let settings = flock.line_settings();
    let session = Session::start(flock, settings, clock, tell);
    node.ready()?;
    let mut scanned = None;
    while let Some(go) = node.wait_for_go(scanned)? {
        scanned = Some(go.scan);
        // What came before the go teaches the clocks, and is not sent.
        while let Some(arrived) = session.next(Duration::ZERO) {
            tracker.process(&arrived.record, arrived.nanos, arrived.missed);
        }
        scan(&mut node, &go, &session, &mut tracker, &mut outputs, clock)?;
    }
    node.close()
}

fn scan(
    node: &mut Node,
    go: &Go,
    session: &Session<Heard>,
    tracker: &mut FlockTracker,
    outputs: &mut [Output<Pose>],
    clock: HostClock,
) -> anyhow::Result<()> {
    let before = session.counts();
    let mut last = go.epoch_nanos;
    // The device itself paces this source: its turn has always come.
    while node.wait_for_turn(go, -go.epoch_nanos) {
        let Some(arrived) = session.next(NAP) else { continue };
        let Some(SensorPose { sensor, mut pose, .. }) = tracker.process(&arrived.record, arrived.nanos, arrived.missed)
        else {
            node.refuse("record of a unit that is not in `sensors`", 1);
            continue;
        };
        pose.header.scan = go.scan;
        pose.header.phase = node.phase().map_or(go.phase, |run| run.header.phase);
        pose.header.stamp_nanos = clock.system_nanos(pose.header.stamp_nanos);
        let header = pose.header;
        last = last.max(header.stamp_nanos);
        outputs[sensor].send(pose)?;
        node.finished(&header)?;
    }
    let after = session.counts();
    node.refuse("record that came in pieces", after.broken - before.broken);
    if after.overflowed > before.overflowed {
        tracing::error!(
            "{} records were not fetched in time: the machine is too busy",
            after.overflowed - before.overflowed
        );
    }
    if let Some((rms, most)) = tracker.jitter_nanos(0) {
        tracing::info!("arrivals were freed of {:.2} ms rms of jitter, {:.1} ms at most", rms * 1e-6, most * 1e-6);
    }
    let header =
        Header { scan: go.scan, phase: Phase::End, stamp_nanos: last + 1, clock: Clock::System, ..Header::default() };
    for output in outputs {
        output.send(Pose::none(header, "the scan has ended"))?;
    }
    node.finished(&header)
}

fn tell(news: News) {
    match news {
        News::Streaming(found) => tracing::info!("{found}"),
        News::Trouble(trouble) => tracing::error!("{trouble}"),
        News::Noisy(sentence) => tracing::warn!("{sentence}"),
    }
}
