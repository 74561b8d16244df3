//! One scan on its way through the node: relayed as it comes, refined beside that, sent again when it is better.

use crate::worker::{Answer, Worker};
use crate::{Config, Evidence, Refinement, sentence, tell};
use anyhow::Context as _;
use kit::{Node, Output};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use wire::{Bulk, Calibration, Header, Phase, Scan, Trajectory};

/// Where everything goes.
pub(crate) struct Outputs {
    pub scans: Output<Scan>,
    pub ways: Output<Trajectory>,
    pub accounts: Output<wire::Refinement>,
}

/// How far one scan has come.
pub(crate) struct Course {
    config: Config,
    calibration: Calibration,
    outputs: Outputs,
    pub worker: Worker,
    scan: u64,
    revision: u32,
    /// What register made of it: the last resort, should nothing better come.
    placed: Vec<Scan>,
    way: Vec<Trajectory>,
    /// Of poses, profiles, scans and trajectories.
    pub ends: [Option<Header>; 4],
    ticking: bool,
    finishing: bool,
    told: Instant,
}

impl Course {
    pub fn new(config: Config, calibration: Calibration, outputs: Outputs) -> anyhow::Result<Self> {
        Ok(Self {
            worker: Worker::start(&config, &calibration)?,
            config,
            calibration,
            outputs,
            scan: 0,
            revision: 0,
            placed: Vec::new(),
            way: Vec::new(),
            ends: [None; 4],
            ticking: false,
            finishing: false,
            told: Instant::now(),
        })
    }

    /// A higher scan starts afresh.
    pub fn begin(&mut self, header: &Header) -> anyhow::Result<()> {
        if header.scan > self.scan {
            self.worker = Worker::start(&self.config, &self.calibration)?;
            (self.scan, self.revision, self.ends) = (header.scan, 0, [None; 4]);
            (self.ticking, self.finishing, self.told) = (false, false, Instant::now());
            self.placed.clear();
            self.way.clear();
        }
        Ok(())
    }

    /// Whether all that the scan is made of has come.
    fn has_all(&self) -> bool {
        self.ends.iter().all(Option::is_some)
    }

    /// Gives the worker what is due: the last refinement once everything has come, a live one now and then before.
    pub fn refine(&mut self) -> anyhow::Result<()> {
        if self.has_all() && !self.finishing {
            self.worker.finish()?;
            self.finishing = true;
        } else if self.is_tick_due() {
            self.worker.tick()?;
            self.ticking = true;
        }
        Ok(())
    }

    fn is_tick_due(&self) -> bool {
        let every = Duration::from_secs_f64(self.config.live_every_s);
        !every.is_zero() && !self.ticking && !self.finishing && !self.placed.is_empty() && self.told.elapsed() >= every
    }

    pub fn relay_scan(&mut self, node: &mut Node, scan: Scan) -> anyhow::Result<()> {
        if scan.header.is_end() {
            self.ends[2] = Some(scan.header);
            return Ok(());
        }
        self.placed.push(scan.clone());
        let header = Header { revision: self.revision, ..scan.header.derived() };
        self.outputs.scans.send(Scan { header, ..scan })?;
        node.finished(&header)
    }

    pub fn relay_way(&mut self, way: Trajectory) -> anyhow::Result<()> {
        if way.header.is_end() {
            self.ends[3] = Some(way.header);
            return Ok(());
        }
        self.way.push(way.clone());
        let header = Header { revision: self.revision, ..way.header.derived() };
        Ok(self.outputs.ways.send(Trajectory { header, ..way })?)
    }

    pub fn take(&mut self, node: &mut Node, answer: Answer) -> anyhow::Result<()> {
        self.ticking = false;
        self.told = Instant::now();
        match answer {
            Answer::Live(None) => Ok(()),
            Answer::Live(Some(refinement)) if !self.finishing => {
                let points: usize = self.placed.iter().map(|scan| scan.points.len()).sum();
                self.revise(node, &refinement, points.div_ceil(self.config.live_points.max(1)).max(1))
            }
            Answer::Live(Some(_)) => Ok(()),
            Answer::Final(outcome) => {
                match outcome {
                    Ok(refinement) => {
                        say(node, &refinement.evidence);
                        self.revise(node, &refinement, 1)?;
                    }
                    Err(error) => {
                        tracing::warn!("not refined, the scan stays as the tracker has it: {error}");
                        node.refuse("scan that cannot be refined", 1);
                        self.repeat(node)?;
                    }
                }
                self.end(node)
            }
        }
    }

    /// The next revision. It goes along with the seconds since the operator's word, so that this node, started again in
    /// mid-scan, counts on behind what it sent before.
    fn count_on(&mut self, node: &Node) {
        let begun_nanos = node.phase().map_or(0, |phase| phase.header.stamp_nanos);
        let now_nanos = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_nanos() as i64);
        let seconds = ((now_nanos - begun_nanos) / 1_000_000_000).clamp(0, i64::from(u32::MAX >> 1)) as u32;
        self.revision = seconds.max(self.revision + 1);
    }

    /// Sends the scan so far as the next revision, of each profile every `one_in`th point.
    fn revise(&mut self, node: &Node, refinement: &Refinement, one_in: usize) -> anyhow::Result<()> {
        self.count_on(node);
        let Some(first) = self.placed.first().map(|scan| scan.header) else { return Ok(()) };
        let header = Header { revision: self.revision, ..first.derived() };
        let stamp_nanos = refinement.trajectory.last().map_or(first.stamp_nanos, |pose| pose.stamp_nanos);
        let samples: Bulk<_> = refinement.trajectory.iter().map(wire::TrajectorySample::from).collect();
        let header = Header { stamp_nanos, ..header };
        self.outputs.ways.send(Trajectory { header, samples })?;
        self.outputs.accounts.send(tell::message(&refinement.evidence, header))?;
        for scan in refinement.scans() {
            let header = Header { revision: self.revision, ..scan.header.derived() };
            let points = scan.points.iter().step_by(one_in).copied().collect();
            self.outputs.scans.send(Scan { header, points, ..scan })?;
        }
        Ok(())
    }

    /// Sends what register made of the scan, whole, after revisions that were not.
    fn repeat(&mut self, node: &Node) -> anyhow::Result<()> {
        if self.revision == 0 {
            return Ok(());
        }
        self.count_on(node);
        let revision = self.revision;
        for way in std::mem::take(&mut self.way) {
            let header = Header { revision, ..way.header.derived() };
            self.outputs.ways.send(Trajectory { header, ..way })?;
        }
        for scan in std::mem::take(&mut self.placed) {
            let header = Header { revision, ..scan.header.derived() };
            self.outputs.scans.send(Scan { header, ..scan })?;
        }
        Ok(())
    }

    fn end(&mut self, node: &mut Node) -> anyhow::Result<()> {
        let end = self.ends[2].context("an end that nobody sent")?;
        let header = Header { revision: self.revision, phase: Phase::End, ..end.derived() };
        self.outputs.ways.send(Trajectory { header, samples: Bulk::default() })?;
        self.outputs.scans.send(Scan::none(header))?;
        node.finished(&header)
    }
}

fn say(node: &mut Node, evidence: &Evidence) {
    evidence.refused.iter().for_each(|refused| node.refuse(&refused.reason, refused.count));
    node.refuse("point where other strokes looked through", evidence.seen_through as u64);
    node.refuse("frame that fits nowhere or is held by nothing", evidence.dropped.len() as u64);
    evidence.notices.iter().for_each(|notice| tracing::warn!("{}", sentence(notice)));
    tracing::info!(
        "points stand {:.3} mm off their surface, {:.3} mm before; clock {:+.1} ms; {} frames kept, {} dropped",
        evidence.residual.after_mm,
        evidence.residual.before_mm,
        evidence.clock.tau_ms,
        evidence.frames_kept,
        evidence.dropped.len()
    );
}
