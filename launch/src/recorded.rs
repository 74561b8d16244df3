//! What a recording or a scan folder brings to a pipeline: what is in it, and the settings that it was made with.

use crate::nodes;
use crate::plan::Plan;
use anyhow::{Context as _, Result, bail};
use replay::Source;
use std::path::Path;

/// Nodes whose settings belong to the scan: a handset's line is as wide as it was when it is played again.
const OF_THE_SCAN: [&str; 7] = ["stripe", "triangulate", "register", "refine", "cluster", "surface", "paint"];
/// But for what belongs to the one who looks on.
const OF_THE_RUN: [&str; 1] = ["live_every_s"];

/// What is in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recorded {
    laser_pictures: bool,
    /// NODE.KEY=VALUE, where it is not the default.
    settings: Vec<String>,
}

impl Recorded {
    /// Looks into a recording (MCAP) or a scan folder. Fails when nothing in it tells of a shape.
    pub fn look(input: &Path) -> Result<Self> {
        let source = Source::open(input)?;
        let Source::Recording(recording) = &source else {
            return Ok(Self { laser_pictures: true, settings: Vec::new() });
        };
        let streams = recording.streams();
        let holds = |kind: &str, stream: &str| {
            streams.iter().any(|held| held.key.starts_with(kind) && held.key.ends_with(stream))
        };
        let laser_pictures = holds("camera/", "/frame");
        if !laser_pictures && !holds("stripe/", "/stripe") {
            bail!("{}: neither laser-lit pictures nor stripes in it: there is no shape to find", input.display());
        }
        let configuration = recording.metadata().remove("configuration").unwrap_or_default();
        let settings = settings(&configuration)
            .with_context(|| format!("the configuration that {} was made with", input.display()))?;
        Ok(Self { laser_pictures, settings })
    }

    /// As `--set` has it, for a launch file with a node `replay` that plays the file.
    pub fn sets(&self, input: &Path, launch: &Path) -> Result<Vec<String>> {
        // Quoted: a file may be called `1` or `true`.
        let file = toml::Value::String(input.to_string_lossy().into_owned());
        let mut sets = vec![format!("replay.file={file}")];
        let plan = Plan::load(launch, &sets, nodes::KINDS)?;
        let takes = |set: &&String| set.split_once('.').is_some_and(|(node, _)| plan.node(node).is_some());
        sets.extend(self.settings.iter().filter(takes).cloned());
        if !self.laser_pictures {
            // The stripes in it stand for the pictures in which they were found.
            sets.push("replay.stripes=true".to_owned());
            sets.extend(plan.node("stripe").map(|_| "nodes.stripe.enabled=false".to_owned()));
        }
        Ok(sets)
    }
}

/// What a configuration says of the scan's nodes beyond their defaults.
fn settings(configuration: &str) -> Result<Vec<String>> {
    let table: toml::Table = configuration.parse()?;
    let nodes = table.get("nodes").and_then(toml::Value::as_table);
    let mut settings = Vec::new();
    for (name, node) in nodes.into_iter().flatten() {
        let kind = node.get("kind").and_then(toml::Value::as_str).unwrap_or(name);
        let Some(kind) = nodes::find(kind).filter(|kind| OF_THE_SCAN.contains(&kind.name)) else { continue };
        let defaults = (kind.defaults)();
        let said = node.get("config").and_then(toml::Value::as_table).into_iter().flatten();
        for (key, value) in said.filter(|(key, _)| !OF_THE_RUN.contains(&key.as_str())) {
            if serde_json::to_value(value)? != defaults[key] {
                settings.push(format!("{name}.{key}={value}"));
            }
        }
    }
    Ok(settings)
}
