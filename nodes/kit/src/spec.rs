//! What a launcher tells a node.

use crate::Pace;
use anyhow::Context as _;
use bus::BusConfig;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::BufRead;

/// A node's whole configuration: one line of JSON on its stdin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodeSpec {
    /// What it does: `stripe`, `register`, …
    pub kind: String,
    /// Which one of its kind: a-z, 0-9 and _.
    pub instance: String,
    /// Where the bus is.
    #[serde(default)]
    pub bus: BusConfig,
    /// Whether simulated and replayed sources keep to real time.
    #[serde(default)]
    pub pace: Pace,
    /// At a fast pace, how far a source may run ahead of the slowest of its consumers, in scan time.
    #[serde(default = "default_window_ms")]
    pub window_ms: u64,
    /// kind/instance of the nodes that a source at a fast pace waits for.
    #[serde(default)]
    pub consumers: Vec<String>,
    /// kind/instance of the nodes that must be ready before a source starts.
    #[serde(default)]
    pub wait_for: Vec<String>,
    /// Whose streams it takes: `camera = "head"`.
    #[serde(default)]
    pub inputs: BTreeMap<String, String>,
    /// The node's own configuration.
    #[serde(default)]
    pub config: serde_json::Value,
    /// For a node that is started again: the number, on its own topic, of the message behind the last one that its former
    /// process has finished. What came from there on, and nobody has kept, is lost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next_seq: Option<u64>,
    /// What is logged: `info`, `debug`, `warn`, or a filter as `RUST_LOG` has it.
    #[serde(default = "default_log")]
    pub log: String,
}

fn default_window_ms() -> u64 {
    400
}

fn default_log() -> String {
    "info".to_owned()
}

impl NodeSpec {
    /// A node with all defaults: for tests, and for a start by hand.
    pub fn new(kind: &str, instance: &str, bus: BusConfig) -> Self {
        Self {
            kind: kind.to_owned(),
            instance: instance.to_owned(),
            bus,
            pace: Pace::Real,
            window_ms: default_window_ms(),
            consumers: Vec::new(),
            wait_for: Vec::new(),
            inputs: BTreeMap::new(),
            config: serde_json::Value::Null,
            next_seq: None,
            log: default_log(),
        }
    }

    /// Reads the first line of stdin, and leaves the rest to the lifeline.
    pub fn from_stdin() -> anyhow::Result<Self> {
        let mut line = String::new();
        std::io::stdin().lock().read_line(&mut line).context("reading the configuration from stdin")?;
        serde_json::from_str(&line)
            .context("a node's configuration is one line of JSON on stdin; `limn up FILE` writes it")
    }

    /// kind/instance.
    pub fn name(&self) -> String {
        format!("{}/{}", self.kind, self.instance)
    }

    /// Whose stream to take for an input; `head` when the launch file does not say.
    pub fn source_of(&self, input: &str) -> &str {
        self.inputs.get(input).map_or("head", String::as_str)
    }

    /// The node's own configuration; nothing at all means all defaults.
    pub fn config<C: DeserializeOwned + Default>(&self) -> anyhow::Result<C> {
        if self.config.is_null() {
            return Ok(C::default());
        }
        serde_json::from_value(self.config.clone()).with_context(|| format!("configuration of {}", self.name()))
    }
}
