//! The life of a node that sends what a tracker on a serial line says.

use crate::{Device, HostClock, LineSettings, News, PoseTracker, SensorPose, Session, Trouble};
use anyhow::Context as _;
use kit::{Go, Node, Output};
use std::time::{Duration, Instant};
use wire::{Clock, Header, Phase, Pose, topic};

/// How long the line may be quiet before the operator is listened to.
const NAP: Duration = Duration::from_millis(20);
/// While a scan runs, the jitter that is taken off is told so often; and when it has ended.
const JITTER_TOLD_EVERY: Duration = Duration::from_secs(10);

/// A tracker and its device.
pub struct Source<T, D> {
    /// Turns records into poses.
    pub tracker: T,
    /// Gives the records.
    pub device: D,
    /// How the port is opened.
    pub line: LineSettings,
    /// The number of each sensor: the first one's poses go to `tracker/<instance>`, those of others to
    /// `tracker/<instance>_<number>`.
    pub sensors: Vec<u8>,
    /// Stamps count from the beginning of the scan, as those of a simulated camera do; else they are the system clock's.
    pub scan_clock: bool,
}

/// Sends the poses of one scan after the other until it is told to stop.
pub fn run<T: PoseTracker, D: Device<Record = T::Record>>(mut node: Node, source: Source<T, D>) -> anyhow::Result<()> {
    let mut outputs = Vec::new();
    for (sensor, number) in source.sensors.iter().enumerate() {
        let instance = node.instance().to_owned();
        let name = if sensor == 0 { instance } else { format!("{instance}_{number}") };
        outputs.push(node.output(&topic::pose(&name)).with_context(|| format!("poses of sensor {number}"))?);
    }
    let clock = HostClock::start();
    let session = Session::start(source.device, source.line, clock, tell);
    let Source { tracker, sensors, scan_clock, .. } = source;
    let mut live = Live { tracker, sensors, session, outputs, clock, scan_clock };
    if !node.wait_for_device(|| live.session.counts().records > 0) {
        return node.close();
    }
    node.ready()?;
    let mut scanned = None;
    while let Some(go) = node.wait_for_go(scanned)? {
        scanned = Some(go.scan);
        // What came before the go teaches the clocks, and is not sent.
        while live.next(Duration::ZERO).is_some() {}
        live.scan(&mut node, &go)?;
    }
    node.close()
}

/// A tracker that is listened to.
struct Live<T: PoseTracker> {
    tracker: T,
    sensors: Vec<u8>,
    session: Session<T::Record>,
    outputs: Vec<Output<Pose>>,
    clock: HostClock,
    scan_clock: bool,
}

impl<T: PoseTracker> Live<T> {
    /// The pose in the next record; within, `None` for a sensor that was not asked for.
    fn next(&mut self, wait: Duration) -> Option<Option<SensorPose>> {
        let arrived = self.session.next(wait)?;
        Some(self.tracker.process(&arrived.record, arrived.nanos, arrived.missed))
    }

    fn scan(&mut self, node: &mut Node, go: &Go) -> anyhow::Result<()> {
        let before = self.session.counts();
        let (zero_nanos, clock) = if self.scan_clock { (go.epoch_nanos, Clock::Scan) } else { (0, Clock::System) };
        let mut last = go.epoch_nanos - zero_nanos;
        let mut told = Instant::now();
        // The device itself paces this source: its turn has always come.
        while node.wait_for_turn(go, -go.epoch_nanos) {
            let Some(heard) = self.next(NAP) else { continue };
            let Some(SensorPose { sensor, mut pose, .. }) = heard else {
                node.refuse(T::STRANGER, 1);
                continue;
            };
            pose.header.scan = go.scan;
            pose.header.phase = node.phase().map_or(go.phase, |run| run.header.phase);
            pose.header.stamp_nanos = self.clock.system_nanos(pose.header.stamp_nanos) - zero_nanos;
            pose.header.clock = clock;
            let header = pose.header;
            last = last.max(header.stamp_nanos);
            self.outputs[sensor].send(pose)?;
            node.finished(&header)?;
            if told.elapsed() >= JITTER_TOLD_EVERY {
                told = Instant::now();
                self.tell_jitter();
            }
        }
        let after = self.session.counts();
        node.refuse("record that came in pieces", after.broken - before.broken);
        if after.overflowed > before.overflowed {
            let lost = after.overflowed - before.overflowed;
            tracing::error!("{lost} records were not fetched in time: the machine is too busy");
        }
        self.tell_jitter();
        let header = Header { scan: go.scan, phase: Phase::End, stamp_nanos: last + 1, clock, ..Header::default() };
        for output in &mut self.outputs {
            output.send(Pose::none(header, "the scan has ended"))?;
        }
        node.finished(&header)
    }

    fn tell_jitter(&self) {
        for (sensor, number) in self.sensors.iter().enumerate() {
            let Some((rms, most)) = self.tracker.jitter_nanos(sensor) else { continue };
            let (rms, most) = (rms * 1e-6, most * 1e-6);
            tracing::info!("sensor {number}: arrivals are freed of {rms:.2} ms rms of jitter, {most:.1} ms at most");
        }
    }
}

/// Puts news of a line into the node's log.
pub fn tell(news: News) {
    match news {
        News::Streaming(found) => tracing::info!("{found}"),
        News::Trouble(Trouble::Starting(sentence)) => tracing::warn!("{sentence}"),
        News::Trouble(trouble) => tracing::error!("{trouble}"),
        News::Noisy(sentence) => tracing::warn!("{sentence}"),
    }
}
