//! `limn node KIND --instance NAME`: this process becomes one node.

use crate::kind::Kind;
use crate::nearest::nearest;
use crate::nodes::{self, KINDS};
use crate::story::story;
use anyhow::{Context as _, Result, bail};
use kit::{Node, NodeSpec};

/// Reads the configuration from standard input and lives as the node until that closes.
pub fn run(kind: &str, instance: &str) -> Result<()> {
    let Some(found) = nodes::find(kind) else {
        let known: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
        // No log yet: the launcher reads the level from the line.
        eprintln!("ERROR this limn has no node of kind {kind:?}{}", nearest(kind, &known));
        bail!("no node of kind {kind:?}");
    };
    let outcome = live(found, instance);
    if let Err(error) = &outcome {
        eprintln!("ERROR {}", story(error));
    }
    outcome
}

fn live(kind: &Kind, instance: &str) -> Result<()> {
    let spec = NodeSpec::from_stdin()?;
    if (spec.kind.as_str(), spec.instance.as_str()) != (kind.name, instance) {
        bail!("started as {}/{instance}, but the configuration on standard input is for {}", kind.name, spec.name());
    }
    let name = spec.name();
    let node = Node::open(spec).with_context(|| format!("starting {name}"))?;
    (kind.run)(node).with_context(|| name)
}
