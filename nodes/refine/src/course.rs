//! One scan on its way through the node: relayed as it comes, refined beside that, what of it stands better sent again.

use crate::readers::{Outputs, Readers};
use crate::worker::{Answer, Worker};
use crate::{Config, Evidence, Notice, sentence};
use anyhow::Context as _;
use kit::Node;
use std::mem::Discriminant;
use std::time::{Duration, Instant};
use wire::{Calibration, Header, Scan, Trajectory};

/// How far one scan has come.
pub(crate) struct Course {
    config: Config,
    calibration: Calibration,
    readers: Readers,
    pub worker: Worker,
    scan: u64,
    /// What register made of it: the last resort, should nothing better come.
    placed: Vec<Scan>,
    ways: Vec<Trajectory>,
    /// Of poses, profiles, scans and trajectories.
    pub ends: [Option<Header>; 4],
    ticking: bool,
    finishing: bool,
    told: Instant,
    /// The live notices that the log has.
    noticed: Vec<Discriminant<Notice>>,
}

impl Course {
    pub fn new(config: Config, calibration: Calibration, outputs: Outputs) -> anyhow::Result<Self> {
        Ok(Self {
            worker: Worker::start(&config, &calibration)?,
            config,
            calibration,
            readers: Readers::new(outputs),
            scan: 0,
            placed: Vec::new(),
            ways: Vec::new(),
            ends: [None; 4],
            ticking: false,
            finishing: false,
            told: Instant::now(),
            noticed: Vec::new(),
        })
    }

    /// A higher scan starts afresh.
    pub fn begin(&mut self, header: &Header) -> anyhow::Result<()> {
        if header.scan > self.scan {
            self.worker = Worker::start(&self.config, &self.calibration)?;
            (self.scan, self.ends) = (header.scan, [None; 4]);
            (self.ticking, self.finishing, self.told) = (false, false, Instant::now());
            self.readers.begin();
            self.placed.clear();
            self.ways.clear();
            self.noticed.clear();
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
        let header = scan.header;
        if header.is_end() {
            self.ends[2] = Some(header);
            return Ok(());
        }
        self.readers.relay_scan(scan.clone())?;
        self.placed.push(scan);
        node.finished(&header)
    }

    pub fn relay_way(&mut self, way: Trajectory) -> anyhow::Result<()> {
        if way.header.is_end() {
            self.ends[3] = Some(way.header);
            return Ok(());
        }
        self.readers.relay_way(way.clone())?;
        self.ways.push(way);
        Ok(())
    }

    pub fn take(&mut self, node: &mut Node, answer: Answer) -> anyhow::Result<()> {
        self.ticking = false;
        self.told = Instant::now();
        match answer {
            Answer::Live(None) => Ok(()),
            Answer::Live(Some(refinement)) if !self.finishing => {
                self.warn(&refinement.evidence);
                self.readers.revise(node, &self.config, &refinement, &self.placed, &self.ways)
            }
            Answer::Live(Some(_)) => Ok(()),
            Answer::Final(outcome) => {
                match outcome {
                    Ok(refinement) => {
                        say(node, &refinement.evidence);
                        self.readers.conclude(node, &refinement)?;
                    }
                    Err(error) => {
                        tracing::warn!("not refined, the scan stays as the tracker has it: {error}");
                        node.refuse("scan that cannot be refined", 1);
                        let (placed, ways) = (std::mem::take(&mut self.placed), std::mem::take(&mut self.ways));
                        self.readers.repeat(node, placed, ways)?;
                    }
                }
                let end = self.ends[2].context("an end that nobody sent")?;
                let header = self.readers.end(&end)?;
                node.finished(&header)
            }
        }
    }

    /// Says what was noticed while there is still time to do something about it: each kind once.
    fn warn(&mut self, evidence: &Evidence) {
        for notice in &evidence.notices {
            let kind = std::mem::discriminant(notice);
            if self.noticed.contains(&kind) {
                continue;
            }
            self.noticed.push(kind);
            match notice {
                // The next tick may do better.
                Notice::StepTakenBack | Notice::KeptSmoothed => tracing::debug!("for now: {}", sentence(notice)),
                _ => tracing::warn!("{}", sentence(notice)),
            }
        }
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
