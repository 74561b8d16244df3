//! `[nodes.NAME]`: one node of a rig.

use crate::clocks;
use crate::config;
use crate::graph;
use crate::kind::{DEFAULT_INSTANCE, Inputs, Kind};
use crate::nearest::nearest;
use crate::plan::Plan;
use crate::section::Section;
use crate::setting::{Origin, Setting, Value};
use anyhow::{Result, bail};
use std::path::PathBuf;
use wire::topic::check_name;

/// What a node may say in a launch file.
const KNOWN: &[&str] = &[
    "kind", "instance", "source", "inputs", "config", "exec", "args", "takes", "gives", "machine", "restart",
    "required", "paces", "enabled",
];

/// Whether a node that ended with an error is started again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Restart {
    /// It stays down.
    Never,
    /// It is, with growing pauses, until it has failed too often.
    OnFailure,
}

/// A program that is not built into this one, started with the same words and the same standard input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exec {
    /// The program.
    pub program: PathBuf,
    /// Before `node KIND --instance NAME`.
    pub args: Vec<String>,
}

/// One node of a rig.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedNode {
    /// Its name in the launch file and in the log.
    pub name: String,
    /// What it is.
    pub kind: String,
    /// Which of its kind, and which inputs feed it.
    pub inputs: Inputs,
    /// Starts when all others are ready.
    pub source: bool,
    /// A fast source waits for it.
    pub paces: bool,
    /// The rig has failed when it has failed for good.
    pub required: bool,
    /// What to do when it fails.
    pub restart: Restart,
    /// Written by others.
    pub exec: Option<Exec>,
    /// Where it runs; here when not said.
    pub machine: Option<String>,
    /// Keys that it subscribes to.
    pub takes: Vec<String>,
    /// Keys that it publishes.
    pub gives: Vec<String>,
    /// Its own configuration, whole.
    pub config: serde_json::Value,
}

impl PlannedNode {
    /// kind/instance: how the bus knows it.
    pub fn address(&self) -> String {
        format!("{}/{}", self.kind, self.inputs.instance)
    }
}

/// Reads all nodes into the plan and checks them against each other.
pub(crate) fn read(plan: &mut Plan, kinds: &[Kind]) -> Result<()> {
    let Some(Setting { value: Value::Table(table), .. }) = plan.settings.get("nodes").cloned() else {
        bail!("the launch file has no [nodes.NAME]: there is nothing to start");
    };
    for (name, setting) in &table {
        if check_name(name).is_err() || crate::plan::SECTIONS.contains(&name.as_str()) {
            bail!("{}: {name:?} cannot name a node: 1 to 40 of a-z, 0-9 and _, and no section's name", setting.origin);
        }
        let section = Section::new(&format!("nodes.{name}"), Some(setting), KNOWN)?;
        if section.truth("enabled")?.unwrap_or(true) {
            node(plan, kinds, name, setting, &section)?;
        }
    }
    plan.nodes.sort_by_key(|node| node.source);
    check_addresses(plan)?;
    // Every recording tells under which configuration it was made.
    let whole = plan.to_toml();
    let notes = plan.nodes.iter_mut().filter_map(|node| node.config.get_mut("rig_config"));
    notes.for_each(|note| *note = whole.as_str().into());
    let warnings: Vec<String> = graph::warnings(plan).into_iter().chain(clocks::warnings(plan)).collect();
    plan.warnings.extend(warnings);
    Ok(())
}

fn node(plan: &mut Plan, kinds: &[Kind], name: &str, setting: &Setting, section: &Section<'_>) -> Result<()> {
    let kind_name = section.text("kind")?.unwrap_or_else(|| name.to_owned());
    let exec = section.path("exec")?;
    let kind = kinds.iter().find(|kind| kind.name == kind_name);
    let required = section.truth("required")?.unwrap_or(kind.is_none_or(|kind| kind.required));
    if kind.is_none() && exec.is_none() {
        let origin = if section.get("kind").is_some() { section.origin("kind") } else { setting.origin.clone() };
        let known: Vec<&str> = kinds.iter().map(|kind| kind.name).collect();
        let unknown = format!("{origin}: nodes.{name}: this limn has no node of kind {kind_name:?}");
        if required {
            bail!("{unknown}{}", nearest(&kind_name, &known));
        }
        plan.warnings.push(format!("{unknown}; it is left out, as it is not required"));
        plan.settings_drop_node(name);
        return Ok(());
    }
    if check_name(&kind_name).is_err() {
        bail!("{}: {kind_name:?} cannot name a kind: 1 to 40 of a-z, 0-9 and _", section.origin("kind"));
    }
    let kind = kind.filter(|_| exec.is_none());
    let inputs = inputs(section, kind)?;
    let config = config::effective(plan, name, section.get("config"), kind)?;
    let (takes, gives) = (section.texts("takes")?.unwrap_or_default(), section.texts("gives")?.unwrap_or_default());
    plan.nodes.push(PlannedNode {
        name: name.to_owned(),
        source: section.truth("source")?.unwrap_or(kind.is_some_and(|kind| kind.source)),
        paces: section.truth("paces")?.unwrap_or(kind.is_some_and(|kind| kind.paces)),
        required,
        restart: section
            .word("restart", &[("never", Restart::Never), ("on-failure", Restart::OnFailure)])?
            .unwrap_or(Restart::OnFailure),
        exec: exec
            .map(|program| anyhow::Ok(Exec { program, args: section.texts("args")?.unwrap_or_default() }))
            .transpose()?,
        machine: machine(plan, name, section)?,
        takes: kind.map_or(takes, |kind| [(kind.takes)(&inputs), (kind.takes_more)(&inputs, &config)].concat()),
        gives: kind.map_or(gives, |kind| [(kind.gives)(&inputs), (kind.gives_more)(&inputs, &config)].concat()),
        kind: kind_name,
        inputs,
        config,
    });
    Ok(())
}

fn inputs(section: &Section<'_>, kind: Option<&Kind>) -> Result<Inputs> {
    let instance = section.text("instance")?.unwrap_or_else(|| DEFAULT_INSTANCE.to_owned());
    if let Err(error) = check_name(&instance) {
        bail!("{}: {error}", section.origin("instance"));
    }
    let bound = section.text_table("inputs")?;
    let origin = section.origin("inputs");
    for (input, feeder) in &bound {
        if let Some(kind) = kind.filter(|kind| !kind.inputs.contains(&input.as_str())) {
            bail!("{origin}: {} has no input {input:?}{}", kind.name, nearest(input, kind.inputs));
        }
        if let Err(error) = check_name(feeder) {
            bail!("{origin}: inputs.{input}: {error}");
        }
    }
    Ok(Inputs { instance, bound })
}

fn machine(plan: &Plan, name: &str, section: &Section<'_>) -> Result<Option<String>> {
    let machine = section.text("machine")?;
    if let Some(unknown) = machine.as_deref().filter(|machine| !plan.machines.contains_key(*machine)) {
        let known: Vec<&str> = plan.machines.keys().map(String::as_str).collect();
        let origin: Origin = section.origin("machine");
        bail!("{origin}: nodes.{name}: there is no [machines.{unknown}]{}", nearest(unknown, &known));
    }
    Ok(machine)
}

fn check_addresses(plan: &Plan) -> Result<()> {
    for (index, node) in plan.nodes.iter().enumerate() {
        if let Some(twin) = plan.nodes[..index].iter().find(|other| other.address() == node.address()) {
            bail!("nodes.{} and nodes.{} are both {}: give one another instance", twin.name, node.name, node.address());
        }
    }
    Ok(())
}
