//! The wiring: poses of the receivers come, poses of the body go.

use crate::{Config, Evidence, Fuse};
use anyhow::bail;
use kit::{Input, Node, Output, Pace, STREAM_HISTORY};
use std::time::{Duration, Instant};
use wire::{Header, Pose, topic};

/// At a fast pace nothing comes in its time: a receiver that is silent is told from a busy machine by waiting longer.
const FAST_PATIENCE: Duration = Duration::from_secs(5);

/// Fuses the receivers of a handset until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    config.check()?;
    let names: Vec<String> = config.receivers.iter().map(|receiver| receiver.tracker.clone()).collect();
    if names.iter().any(|name| name == node.instance()) {
        bail!("{}: a receiver is called as the fused pose is: give this node another instance", node.spec().name());
    }
    let inputs = names.iter().map(|name| node.stream(&topic::pose(name), STREAM_HISTORY));
    let mut inputs = inputs.collect::<anyhow::Result<Vec<_>>>()?;
    let mut poses = node.output(&topic::pose(node.instance()))?;
    let most_wait = Duration::from_secs_f64(config.most_wait_ms * 1e-3);
    let patience = if node.spec().pace == Pace::Fast { FAST_PATIENCE } else { most_wait };
    let mut fuse = Fuse::new(config)?;
    let mut silences = Silences::new(names, patience);
    node.ready()?;
    while node.wait() {
        hear(&mut inputs, &mut fuse);
        silences.look(&mut fuse);
        send(&mut node, &mut fuse, &mut poses)?;
        if let Some((end, evidence)) = fuse.end() {
            tell(&evidence);
            poses.send(Pose::none(end, "all receivers have ended"))?;
            node.finished(&end)?;
        }
    }
    node.close()
}

fn hear(inputs: &mut [Input<Pose>], fuse: &mut Fuse) {
    for (receiver, input) in inputs.iter_mut().enumerate() {
        while let Some(pose) = input.next() {
            fuse.pose(receiver, &pose);
        }
    }
}

fn send(node: &mut Node, fuse: &mut Fuse, poses: &mut Output<Pose>) -> anyhow::Result<()> {
    for refusal in fuse.take_refused() {
        node.refuse(&refusal.reason, refusal.count);
    }
    let fused: Vec<Pose> = fuse.drain().collect();
    for pose in fused {
        let header: Header = pose.header;
        poses.send(pose)?;
        node.finished(&header)?;
    }
    Ok(())
}

fn tell(evidence: &Evidence) {
    let Evidence { fused, good, lost, .. } = evidence;
    let apart = evidence.times_apart().map_or_else(
        || "never two at a time".to_owned(),
        |times| format!("{times:.2} times as far apart as they state"),
    );
    tracing::info!(
        "{fused} poses, {good} of them by all receivers, {lost} moments without; the receivers stood {apart}"
    );
    if let Some(advice) = evidence.advice() {
        tracing::warn!("{advice}");
    }
}

/// Which receivers keep the others waiting, and since when on the clock on the wall.
struct Silences {
    names: Vec<String>,
    patience: Duration,
    /// Nothing has gone on since then.
    standing: [Option<i64>; 2],
    since: Instant,
    silent: Vec<bool>,
}

impl Silences {
    fn new(names: Vec<String>, patience: Duration) -> Self {
        let silent = vec![false; names.len()];
        Self { names, patience, standing: [None; 2], since: Instant::now(), silent }
    }

    /// Goes on without those that were waited for long enough. Said once, when it begins and when it ends.
    fn look(&mut self, fuse: &mut Fuse) {
        if self.standing != fuse.standing() {
            (self.standing, self.since) = (fuse.standing(), Instant::now());
        } else if self.since.elapsed() >= self.patience {
            fuse.overdue().into_iter().for_each(|receiver| fuse.go_on_without(receiver));
        }
        for (receiver, name) in self.names.iter().enumerate() {
            let silent = fuse.is_silent(receiver);
            match (std::mem::replace(&mut self.silent[receiver], silent), silent) {
                (false, true) => tracing::warn!("{name} is silent or late: the others go on without it"),
                (true, false) => tracing::info!("{name} is back"),
                _ => {}
            }
        }
    }
}
