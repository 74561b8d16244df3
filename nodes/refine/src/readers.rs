//! What goes to the readers of a scan, and under which revision.

use crate::{Config, Refinement, Shown, tell};
use kit::{Node, Output};
use std::time::{SystemTime, UNIX_EPOCH};
use wire::{Bulk, Extent, Header, Phase, Scan, Trajectory};

/// Where everything goes.
pub(crate) struct Outputs {
    pub scans: Output<Scan>,
    pub ways: Output<Trajectory>,
    pub accounts: Output<wire::Refinement>,
}

/// Who has what of one scan.
pub(crate) struct Readers {
    outputs: Outputs,
    /// Of the first frame.
    begun: Option<Header>,
    revision: u32,
    /// Whether this revision is all of the scan, or what changed of it.
    extent: Extent,
    /// Where the frames stand for them.
    shown: Shown,
    /// Until these moments a refinement has told of frames, and of the way.
    told_nanos: [i64; 2],
}

/// Nothing is refined yet.
const NOTHING: [i64; 2] = [i64::MIN; 2];

impl Readers {
    pub fn new(outputs: Outputs) -> Self {
        let shown = Shown::default();
        Self { outputs, begun: None, revision: 0, extent: Extent::Whole, shown, told_nanos: NOTHING }
    }

    /// Another scan.
    pub fn begin(&mut self) {
        (self.begun, self.revision, self.extent) = (None, 0, Extent::Whole);
        (self.shown, self.told_nanos) = (Shown::default(), NOTHING);
    }

    /// A frame as register has it, unless a refinement was quicker than register.
    pub fn relay_scan(&mut self, scan: Scan) -> anyhow::Result<()> {
        self.begun.get_or_insert(scan.header);
        if scan.header.stamp_nanos <= self.told_nanos[0] {
            return Ok(());
        }
        // The first revision is whole: it ends what came before.
        if self.revision > 0 {
            self.shown.relayed(&scan);
        }
        self.send(scan)
    }

    /// Of a piece of the way as register has it, what lies behind the refined one.
    pub fn relay_way(&mut self, mut way: Trajectory) -> anyhow::Result<()> {
        way.samples.retain(|sample| sample.stamp_nanos > self.told_nanos[1]);
        if way.samples.is_empty() || way.header.stamp_nanos <= self.told_nanos[1] {
            return Ok(());
        }
        self.send_way(way)
    }

    /// A live revision: what changed, and behind it what has come since its refinement began.
    pub fn revise(
        &mut self,
        node: &Node,
        config: &Config,
        refinement: &Refinement,
        placed: &[Scan],
        ways: &[Trajectory],
    ) -> anyhow::Result<()> {
        self.extent = if self.shown.is_empty() { Extent::Whole } else { Extent::Changes };
        let scans = self.shown.changes(refinement, config.live_moved_mm * 1e-3);
        let points: usize = scans.iter().map(|scan| scan.points.len()).sum();
        let one_in = points.div_ceil(config.live_points.max(1)).max(1);
        self.count_on(node);
        self.tell(refinement)?;
        for scan in scans {
            let points = scan.points.iter().step_by(one_in).copied().collect();
            self.send(Scan { points, ..scan })?;
        }
        let way_nanos = refinement.trajectory.last().map_or(i64::MIN, |pose| pose.stamp_nanos);
        self.told_nanos = [refinement.evidence.last_frame_nanos().unwrap_or(i64::MIN), way_nanos];
        let newer = placed.partition_point(|scan| scan.header.stamp_nanos <= self.told_nanos[0]);
        placed[newer..].iter().try_for_each(|scan| self.relay_scan(scan.clone()))?;
        let newer = ways.partition_point(|way| way.header.stamp_nanos <= self.told_nanos[1]);
        ways[newer..].iter().try_for_each(|way| self.relay_way(way.clone()))
    }

    /// The last revision: all of it.
    pub fn conclude(&mut self, node: &Node, refinement: &Refinement) -> anyhow::Result<()> {
        self.extent = Extent::Whole;
        self.count_on(node);
        self.tell(refinement)?;
        refinement.scans().try_for_each(|scan| self.send(scan))
    }

    /// Sends what register made of the scan, whole, after revisions that were not.
    pub fn repeat(&mut self, node: &Node, placed: Vec<Scan>, ways: Vec<Trajectory>) -> anyhow::Result<()> {
        if self.revision == 0 {
            return Ok(());
        }
        self.extent = Extent::Whole;
        self.count_on(node);
        ways.into_iter().try_for_each(|way| self.send_way(way))?;
        placed.into_iter().try_for_each(|scan| self.send(scan))
    }

    /// Nothing follows.
    pub fn end(&mut self, end: &Header) -> anyhow::Result<Header> {
        let header = Header { revision: self.revision, phase: Phase::End, ..end.derived() };
        self.outputs.ways.send(Trajectory { header, samples: Bulk::default() })?;
        self.outputs.scans.send(Scan { extent: self.extent, ..Scan::none(header) })?;
        Ok(header)
    }

    /// The next revision. It goes along with the seconds since the operator's word, so that this node, started again in
    /// mid-scan, counts on behind what it sent before.
    fn count_on(&mut self, node: &Node) {
        let begun_nanos = node.phase().map_or(0, |phase| phase.header.stamp_nanos);
        let now_nanos = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_nanos() as i64);
        let seconds = ((now_nanos - begun_nanos) / 1_000_000_000).clamp(0, i64::from(u32::MAX >> 1)) as u32;
        self.revision = seconds.max(self.revision + 1);
    }

    /// The way of this revision, and what it rests on.
    fn tell(&mut self, refinement: &Refinement) -> anyhow::Result<()> {
        let Some(first) = self.begun else { return Ok(()) };
        let stamp_nanos = refinement.trajectory.last().map_or(first.stamp_nanos, |pose| pose.stamp_nanos);
        let header = Header { revision: self.revision, stamp_nanos, ..first.derived() };
        let samples: Bulk<_> = refinement.trajectory.iter().map(wire::TrajectorySample::from).collect();
        self.outputs.ways.send(Trajectory { header, samples })?;
        Ok(self.outputs.accounts.send(tell::message(&refinement.evidence, header))?)
    }

    fn send(&mut self, scan: Scan) -> anyhow::Result<()> {
        let header = Header { revision: self.revision, ..scan.header.derived() };
        Ok(self.outputs.scans.send(Scan { header, extent: self.extent, ..scan })?)
    }

    fn send_way(&mut self, way: Trajectory) -> anyhow::Result<()> {
        let header = Header { revision: self.revision, ..way.header.derived() };
        Ok(self.outputs.ways.send(Trajectory { header, ..way })?)
    }
}
