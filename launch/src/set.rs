//! `--set node.key=value`: the last word of the configuration.
//!
//! A path that begins with the name of a node goes into that node's configuration: `stripe.min_amplitude=12` is
//! `nodes.stripe.config.min_amplitude`. Any other path starts at the root of the launch file: `run.pace=fast`,
//! `nodes.view.enabled=false`.

use crate::nearest::nearest;
use crate::plan::SECTIONS;
use crate::setting::{Origin, Setting, Settings, Value, merge};
use anyhow::{Result, bail};

/// Lays one `node.key=value` on the settings.
pub fn apply(settings: &mut Settings, argument: &str) -> Result<()> {
    let Some((path, text)) = argument.split_once('=') else {
        bail!("--set {argument}: say node.key=value, as in --set stripe.min_amplitude=12");
    };
    let mut keys: Vec<&str> = path.split('.').map(str::trim).collect();
    if keys.len() < 2 || keys.iter().any(|key| key.is_empty()) {
        bail!("--set {argument}: {path:?} is no node.key");
    }
    let nodes = names(settings);
    if nodes.iter().any(|node| node == keys[0]) {
        keys = ["nodes", keys[0], "config"].into_iter().chain(keys.into_iter().skip(1)).collect();
    } else if !SECTIONS.contains(&keys[0]) {
        let known: Vec<&str> = nodes.iter().map(String::as_str).chain(SECTIONS.iter().copied()).collect();
        bail!("--set {argument}: there is no node or section {:?}{}", keys[0], nearest(keys[0], &known));
    }
    let origin = Origin::Set(argument.to_owned());
    let mut setting = Setting { origin: origin.clone(), value: Value::Leaf(value(text.trim())) };
    while let Some(key) = keys.pop() {
        let table = Settings::from([(key.to_owned(), setting)]);
        setting = Setting { origin: origin.clone(), value: Value::Table(table) };
    }
    if let Value::Table(over) = setting.value {
        merge(settings, over);
    }
    Ok(())
}

fn names(settings: &Settings) -> Vec<String> {
    match settings.get("nodes").map(|nodes| &nodes.value) {
        Some(Value::Table(nodes)) => nodes.keys().cloned().collect(),
        _ => Vec::new(),
    }
}

/// As TOML when it is TOML, else as text: `--set run.pace=fast` needs no quotes.
fn value(text: &str) -> toml::Value {
    let parsed = toml::from_str::<toml::Table>(&format!("value = {text}"));
    match parsed.ok().filter(|table| table.len() == 1).and_then(|mut table| table.remove("value")) {
        Some(value) => value,
        None => toml::Value::String(text.to_owned()),
    }
}
