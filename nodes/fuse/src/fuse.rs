//! Poses of the receivers to poses of the body, moment by moment.

use crate::evidence::Evidence;
use crate::track::{Listening, Track, Waiting};
use crate::{Config, ConfigError};
use nalgebra::Isometry3;
use std::collections::{BTreeMap, VecDeque};
use wire::{Clock, Header, Pose, Refusal};

/// Holds readings until all receivers have told of their moments.
#[derive(Debug, Clone)]
pub struct Fuse {
    pub(crate) config: Config,
    /// body_from_receiver of each.
    pub(crate) mounts: Vec<Isometry3<f64>>,
    pub(crate) tracks: Vec<Track>,
    pub(crate) scan: Option<Scan>,
    pub(crate) fused: VecDeque<Pose>,
    refused: BTreeMap<String, u64>,
}

/// The present scan.
#[derive(Debug, Clone)]
pub(crate) struct Scan {
    number: u64,
    clock: Clock,
    /// The newest moment that was decided.
    pub last_nanos: Option<i64>,
    /// Of the end that was stamped last.
    end: Option<Header>,
    over: bool,
    pub evidence: Evidence,
}

impl Fuse {
    /// For the receivers of one handset.
    pub fn new(config: Config) -> Result<Self, ConfigError> {
        config.check()?;
        // All of them: `check` refuses a mount that is none.
        let mounts: Vec<_> = config.receivers.iter().filter_map(crate::Receiver::body_from_receiver).collect();
        let tracks = vec![Track::new(); mounts.len()];
        Ok(Self { config, mounts, tracks, scan: None, fused: VecDeque::new(), refused: BTreeMap::new() })
    }

    /// Takes a reading of a receiver, counted as the configuration has them, or the end of its stream. A higher scan starts
    /// afresh: what waits of the one before is decided by what has come.
    pub fn pose(&mut self, receiver: usize, pose: &Pose) {
        let header = pose.header;
        if receiver >= self.tracks.len() {
            return self.refuse("pose of a receiver that is not configured".to_owned());
        }
        if self.scan.as_ref().is_none_or(|scan| header.scan > scan.number) {
            self.begin(&header);
        }
        let (Some(scan), track) = (&mut self.scan, &mut self.tracks[receiver]) else { return };
        let taken = if header.scan < scan.number {
            Err("pose of an older scan")
        } else if scan.over || track.listening == Listening::Ended {
            Err("pose behind the end of its scan")
        } else if header.is_end() {
            track.listening = Listening::Ended;
            scan.end = Some(scan.end.filter(|end| end.stamp_nanos >= header.stamp_nanos).unwrap_or(header));
            Ok(())
        } else if header.clock != scan.clock {
            Err("pose on another clock than the first")
        } else {
            track.take(pose, self.config.use_degraded).map_err(|bad| bad.reason())
        };
        // Whoever has caught up is waited for again.
        if track.listening == Listening::Silent && track.heard() > scan.last_nanos {
            track.listening = Listening::Live;
        }
        if let Err(reason) = taken {
            self.refuse_of(receiver, reason);
        }
        self.serve();
    }

    fn begin(&mut self, header: &Header) {
        self.tracks.iter_mut().for_each(|track| track.listening = Listening::Ended);
        self.serve();
        self.tracks.fill_with(Track::new);
        self.scan = Some(Scan {
            number: header.scan,
            clock: header.clock,
            last_nanos: None,
            end: None,
            over: false,
            evidence: Evidence::default(),
        });
    }

    /// The poses that are ready, in the order of their stamps.
    pub fn drain(&mut self) -> impl Iterator<Item = Pose> + '_ {
        self.fused.drain(..)
    }

    /// What was refused since the last call.
    pub fn take_refused(&mut self) -> Vec<Refusal> {
        let refused = std::mem::take(&mut self.refused);
        refused.into_iter().map(|(reason, count)| Refusal { reason, count }).collect()
    }

    /// The newest moment that was decided in this scan, and the stamp of the oldest reading that waits: as long as neither
    /// changes, nothing goes on.
    pub fn standing(&self) -> [Option<i64>; 2] {
        [self.last_nanos(), self.oldest().map(|(_, oldest)| oldest.header.stamp_nanos)]
    }

    pub(crate) fn last_nanos(&self) -> Option<i64> {
        self.scan.as_ref()?.last_nanos
    }

    /// The receivers that keep a moment waiting although another is [`Config::most_wait_ms`] past it, or although all
    /// others have ended. By the stamps alone it cannot be told whether they are silent or their messages on the way: who
    /// has a clock on the wall, and patience, calls [`Fuse::go_on_without`].
    pub fn overdue(&self) -> Vec<usize> {
        let live = |track: &Track| track.listening == Listening::Live;
        let ended = self.tracks.iter().any(|track| track.listening == Listening::Ended);
        let (awaited, passed): (Vec<usize>, bool) = match self.oldest() {
            Some((_, oldest)) => {
                let stamp_nanos = oldest.header.stamp_nanos;
                let bound = stamp_nanos.saturating_add(self.config.most_wait_nanos());
                (self.awaited(stamp_nanos).collect(), self.tracks.iter().any(|track| track.heard() >= Some(bound)))
            }
            None => ((0..self.tracks.len()).filter(|&index| live(&self.tracks[index])).collect(), false),
        };
        let all_awaited = awaited.len() == self.tracks.iter().filter(|track| live(track)).count();
        if passed || ended && all_awaited { awaited } else { Vec::new() }
    }

    /// Waits no longer for a receiver, until it has caught up with the others.
    pub fn go_on_without(&mut self, receiver: usize) {
        if let Some(track) = self.tracks.get_mut(receiver).filter(|track| track.listening == Listening::Live) {
            track.listening = Listening::Silent;
            self.serve();
        }
    }

    /// Whether others go on without this receiver.
    pub fn is_silent(&self, receiver: usize) -> bool {
        self.tracks.get(receiver).is_some_and(|track| track.listening == Listening::Silent)
    }

    /// When all receivers have ended, but for those that are silent: the end of the fused stream, and how well they agreed.
    /// Told once a scan.
    pub fn end(&mut self) -> Option<(Header, Evidence)> {
        let waiting = self.tracks.iter().any(|track| track.listening == Listening::Live || !track.waiting.is_empty());
        let scan = self.scan.as_mut().filter(|scan| !scan.over && !waiting)?;
        let end = scan.end?;
        scan.over = true;
        Some((end.derived(), scan.evidence))
    }

    /// The oldest reading that is not decided yet, and whose it is.
    pub(crate) fn oldest(&self) -> Option<(usize, Waiting)> {
        let fronts = self.tracks.iter().enumerate();
        let fronts = fronts.filter_map(|(index, track)| Some((index, *track.waiting.front()?)));
        fronts.min_by_key(|(index, waiting)| (waiting.header.stamp_nanos, *index))
    }

    pub(crate) fn awaited(&self, stamp_nanos: i64) -> impl Iterator<Item = usize> + '_ {
        let gap_nanos = self.config.most_gap_nanos();
        let tracks = self.tracks.iter().enumerate();
        tracks.filter(move |(_, track)| track.is_waited_for(stamp_nanos, gap_nanos)).map(|(index, _)| index)
    }

    pub(crate) fn name(&self, receiver: usize) -> &str {
        &self.config.receivers[receiver].tracker
    }

    pub(crate) fn refuse_of(&mut self, receiver: usize, reason: &str) {
        self.refuse(format!("{}: {reason}", self.name(receiver)));
    }

    pub(crate) fn refuse(&mut self, reason: String) {
        *self.refused.entry(reason).or_default() += 1;
    }
}
