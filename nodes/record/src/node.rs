//! The wiring: what sources send is kept as it came.
//!
//! What is computed from it can be computed again, so it is not kept; but for the stripes, which hold all that is measured
//! in a laser-lit picture at a hundredth of its size. A laser-lit picture itself is kept on request.

use crate::{Config as Packing, Recorder};
use anyhow::{Context as _, bail};
use kit::{Node, RawInput};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use wire::topic;

/// Which pictures are kept: those that the lamp alone has lit, or all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pictures {
    /// Those that the lamp lit: colour can be painted again, the stripes stand for the rest.
    #[default]
    Lamp,
    /// All of them: stripes can be found again, with other settings.
    All,
}

/// What is recorded, and where.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// The file; one that exists is not overwritten. A recorder that dies goes on in a second part, `scan.2.mcap`.
    pub file: PathBuf,
    /// Which pictures are kept: `lamp` or `all`.
    pub pictures: Pictures,
    /// Noted in the recording: the effective configuration of the rig.
    pub rig_config: String,
    /// How it is packed.
    pub packing: Packing,
}

impl Default for Config {
    fn default() -> Self {
        let (pictures, rig_config, packing) = Default::default();
        Self { file: "scan.mcap".into(), pictures, rig_config, packing }
    }
}

/// Keys that are kept, and how many messages may wait.
fn kept(pictures: Pictures) -> Vec<(String, usize)> {
    let told = [(topic::calibration("*").key, 8), (topic::run_phase().key, 64)];
    let measured = [(topic::pose("*").key, 1 << 14), (topic::stripe("*").key, 1 << 12), (topic::colour("*").key, 48)];
    let all = (pictures == Pictures::All).then(|| (topic::frame("*").key, 48));
    told.into_iter().chain(measured).chain(all).collect()
}

/// Records until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    let inputs = kept(config.pictures).into_iter().map(|(key, depth)| node.raw(&key, depth));
    let mut inputs: Vec<RawInput> = inputs.collect::<anyhow::Result<_>>()?;
    let notes = [("limn", env!("CARGO_PKG_VERSION")), ("configuration", &config.rig_config)];
    let notes: BTreeMap<String, String> = notes.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    let mut recorder = begin(&node, &config, &notes)?;
    node.ready()?;
    let (mut begun, mut ended) = (BTreeSet::new(), BTreeSet::new());
    let mut latest = 0;
    while node.wait() {
        for input in &mut inputs {
            while let Some(message) = input.next() {
                // What cannot be read is counted by the input, and kept all the same: where it came.
                latest = message.header.map_or(latest, |header| header.stamp_nanos);
                recorder.write(&message.key, &message.schema, latest, &message.bytes)?;
                let Some(header) = message.header else { continue };
                let is_stream = ["camera/", "stripe/", "tracker/"].iter().any(|kind| message.key.starts_with(kind));
                if !is_stream {
                    continue;
                }
                begun.insert(message.key.clone());
                if !header.is_end() {
                    ended.remove(&message.key);
                    node.finished(&header)?;
                } else if ended.insert(message.key.clone()) && ended.len() == begun.len() {
                    recorder.flush().context("writing the recording")?;
                    node.finished(&header)?;
                }
            }
        }
    }
    let path = recorder.path().display().to_string();
    let kept = recorder.finish()?;
    tracing::info!("{} messages, {} MB in {path}", kept.messages, kept.bytes >> 20);
    node.close()
}

/// A recorder that is started again goes on beside what it has: what came meanwhile, its senders have kept.
fn begin(node: &Node, config: &Config, notes: &BTreeMap<String, String>) -> anyhow::Result<Recorder> {
    if node.spec().next_seq.is_none() {
        return Ok(Recorder::create(&config.file, config.packing.clone(), notes)?);
    }
    let recorder = Recorder::go_on(&config.file, config.packing.clone(), notes)?;
    let (first, part) = (config.file.display(), recorder.path().display());
    tracing::warn!("the recording goes on in {part}; it is read together with {first}");
    if config.pictures == Pictures::All {
        tracing::warn!("laser-lit pictures that came before are kept by nobody: some are missing in it");
    }
    Ok(recorder)
}

/// Refuses a configuration without a file.
pub fn check(config: &Config) -> anyhow::Result<()> {
    if config.file.as_os_str().is_empty() {
        bail!("file = \"\": name a file for the recording");
    }
    config.packing.check()?;
    Ok(())
}
