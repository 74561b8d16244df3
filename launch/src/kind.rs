//! What the launcher knows of a kind of node.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeMap;

/// A kind of node that is built into this program.
pub struct Kind {
    /// As launch files and `limn node` call it.
    pub name: &'static str,
    /// One line.
    pub about: &'static str,
    /// Begins a stream: starts when all others are ready, and paces itself by their progress.
    pub source: bool,
    /// Reports progress that a fast source waits for. A viewer does not: a stuck viewer slows nobody.
    pub paces: bool,
    /// The rig has failed when this node has failed for good, unless the launch file says otherwise.
    pub required: bool,
    /// What `inputs` may bind to an instance; each is `head` until it is bound.
    pub inputs: &'static [&'static str],
    /// The keys of its configuration that are paths, relative to the file that says them.
    pub paths: &'static [&'static str],
    /// The keys that it subscribes to.
    pub takes: fn(&Inputs) -> Vec<String>,
    /// The keys that it publishes.
    pub gives: fn(&Inputs) -> Vec<String>,
    /// What else it subscribes to, as its configuration says.
    pub takes_more: fn(&Inputs, &Value) -> Vec<String>,
    /// What else it publishes, as its configuration says.
    pub gives_more: fn(&Inputs, &Value) -> Vec<String>,
    /// Its configuration when nothing was said.
    pub defaults: fn() -> Value,
    /// Refuses a configuration that it cannot run with.
    pub check: fn(&Value) -> Result<(), String>,
    /// Lives as this node until it is told to stop.
    pub run: fn(kit::Node) -> anyhow::Result<()>,
}

/// The instance where none is said: the handset of a rig that has only one (as `kit::NodeSpec::source_of` has it).
pub const DEFAULT_INSTANCE: &str = "head";

/// Which instance each input of a node is bound to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Inputs {
    /// The node's own.
    pub instance: String,
    /// As the launch file binds them.
    pub bound: BTreeMap<String, String>,
}

impl Inputs {
    /// The instance that feeds an input.
    pub fn of(&self, input: &str) -> &str {
        self.bound.get(input).map_or(DEFAULT_INSTANCE, String::as_str)
    }
}

/// The defaults of a configuration; an unset option is null.
pub fn defaults<C: Serialize + Default>() -> Value {
    serde_json::to_value(C::default()).unwrap_or_default()
}

/// Reads a configuration and checks it by its own rules.
pub fn check<C: DeserializeOwned, E: std::fmt::Display>(
    config: &Value,
    rules: impl Fn(&C) -> Result<(), E>,
) -> Result<(), String> {
    let config = C::deserialize(config).map_err(|e| e.to_string())?;
    rules(&config).map_err(|e| e.to_string())
}
