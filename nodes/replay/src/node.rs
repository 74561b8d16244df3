//! The wiring: what was recorded comes again, in its own time or as fast as it is taken.

use crate::Source;
use anyhow::{Context as _, bail};
use kit::{Go, Node, Output};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;
use wire::{Calibration, Frame, Header, Phase, Pose, Stripe, topic};

/// What is played.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// A recording (MCAP), or a scan folder.
    pub file: PathBuf,
    /// Play the recorded stripes as well: for a recording without its laser-lit pictures.
    pub stripes: bool,
}

/// One output for each stream, made when its first message comes.
#[derive(Default)]
struct Outputs {
    frames: BTreeMap<String, Output<Frame>>,
    poses: BTreeMap<String, Output<Pose>>,
    stripes: BTreeMap<String, Output<Stripe>>,
    calibrations: BTreeMap<String, Output<Calibration>>,
    /// The last header of each stream that has begun and not ended.
    open: BTreeMap<String, Header>,
}

/// Plays one scan when the operator says go, and stays until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    let source = Source::open(&config.file)?;
    source.damages().iter().for_each(|damage| tracing::warn!("{damage}"));
    let mut outputs = Outputs::default();
    announce(&mut node, &source, &mut outputs)?;
    node.ready()?;
    if let Some(go) = node.wait_for_go(None)? {
        let last = play(&mut node, &config, &source, &mut outputs, &go)?;
        node.finished(&Header { scan: go.scan, phase: Phase::End, stamp_nanos: last, ..Header::default() })?;
        tracing::info!("{} has been played", config.file.display());
        while node.wait() {}
    }
    node.close()
}

/// Nodes are not ready before they know the rig, and nothing is played before they are ready.
fn announce(node: &mut Node, source: &Source, outputs: &mut Outputs) -> anyhow::Result<()> {
    for message in source.messages()? {
        let Ok(message) = message else { continue };
        if message.key.starts_with("rig/") {
            outputs.send_calibration(node, &message)?;
            return Ok(());
        }
    }
    bail!("the recording holds no calibration: without its rig nothing can be measured")
}

/// No recording pauses for longer: a stamp that lies further ahead is a wrong one, and nobody waits for it.
const LONGEST_PAUSE_NANOS: i64 = 3_600_000_000_000;

fn play(node: &mut Node, config: &Config, source: &Source, outputs: &mut Outputs, go: &Go) -> anyhow::Result<i64> {
    let (mut started, mut reached, mut last) = (None, 0, 0);
    for message in source.messages()? {
        let message = match message {
            Ok(message) => message,
            Err(error) => {
                tracing::error!("{error}");
                node.refuse("message that cannot be read", 1);
                continue;
            }
        };
        let is_one_of = |kinds: &[&str]| kinds.iter().any(|kind| message.key.starts_with(kind));
        let stamp_nanos = message.stamp_nanos;
        if is_one_of(&["camera/", "stripe/", "tracker/"]) {
            // The first measurement is now: what was told of the rig before may have another clock's stamp.
            let start = *started.get_or_insert_with(|| {
                reached = stamp_nanos;
                Go { epoch_nanos: go.epoch_nanos.saturating_sub(stamp_nanos), ..*go }
            });
            // Poses go along with the pictures that they belong to.
            if is_one_of(&["camera/", "stripe/"]) && stamp_nanos.saturating_sub(reached) <= LONGEST_PAUSE_NANOS {
                if !node.wait_for_turn(&start, stamp_nanos) {
                    break;
                }
                reached = reached.max(stamp_nanos);
            }
        }
        match outputs.send(node, config, &message, go) {
            Ok(header) => last = header.map_or(last, |header: Header| header.stamp_nanos.max(last)),
            Err(error) => {
                tracing::error!("{}: {error:#}", message.key);
                node.refuse("message of another version", 1);
            }
        }
    }
    outputs.end(node, go)?;
    Ok(last)
}

impl Outputs {
    fn send(
        &mut self,
        node: &mut Node,
        config: &Config,
        message: &crate::Message,
        go: &Go,
    ) -> anyhow::Result<Option<Header>> {
        let [kind, instance, stream] = message.key.split('/').collect::<Vec<_>>()[..] else { return Ok(None) };
        let header = match kind {
            // Stripes that are played stand for the laser-lit pictures.
            "camera" if !(config.stripes && stream == "frame") => {
                let topic = if stream == "frame" { topic::frame(instance) } else { topic::colour(instance) };
                relay(&mut self.frames, node, topic, message.decode()?, go)?
            }
            "tracker" => relay(&mut self.poses, node, topic::pose(instance), message.decode()?, go)?,
            "stripe" if config.stripes => {
                relay(&mut self.stripes, node, topic::stripe(instance), message.decode()?, go)?
            }
            _ => return Ok(None),
        };
        if header.is_end() {
            self.open.remove(&message.key);
        } else {
            self.open.insert(message.key.clone(), header);
        }
        Ok(Some(header))
    }

    fn send_calibration(&mut self, node: &mut Node, message: &crate::Message) -> anyhow::Result<()> {
        let instance = message.key.split('/').nth(1).context("a calibration without an instance")?.to_owned();
        let go = Go { scan: 0, phase: Phase::Aim, epoch_nanos: 0 };
        relay(&mut self.calibrations, node, topic::calibration(&instance), message.decode()?, &go)?;
        Ok(())
    }

    /// A recording that was cut short has no ends: whoever waits for them would wait for ever.
    fn end(&mut self, node: &mut Node, go: &Go) -> anyhow::Result<()> {
        for (key, header) in std::mem::take(&mut self.open) {
            let header = Header {
                scan: go.scan,
                phase: Phase::End,
                stamp_nanos: header.stamp_nanos.saturating_add(1),
                ..header
            };
            let [kind, instance, stream] = key.split('/').collect::<Vec<_>>()[..] else { continue };
            match (kind, stream) {
                ("camera", "frame") => {
                    relay(&mut self.frames, node, topic::frame(instance), crate::folder::empty_frame(header), go)?
                }
                ("camera", _) => {
                    relay(&mut self.frames, node, topic::colour(instance), crate::folder::empty_frame(header), go)?
                }
                ("tracker", _) => relay(
                    &mut self.poses,
                    node,
                    topic::pose(instance),
                    Pose::none(header, "the recording ends here"),
                    go,
                )?,
                _ => relay(&mut self.stripes, node, topic::stripe(instance), crate::folder::no_stripe(header), go)?,
            };
        }
        Ok(())
    }
}

/// Sends a message on its own stream, as part of this scan.
fn relay<M: wire::Message>(
    outputs: &mut BTreeMap<String, Output<M>>,
    node: &mut Node,
    topic: topic::Topic<M>,
    mut message: M,
    go: &Go,
) -> anyhow::Result<Header> {
    message.header_mut().scan = go.scan;
    let header = *message.header();
    if !outputs.contains_key(&topic.key) {
        outputs.insert(topic.key.clone(), node.output(&topic)?);
    }
    if let Some(output) = outputs.get_mut(&topic.key) {
        output.send(message)?;
    }
    Ok(header)
}
