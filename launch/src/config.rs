//! The whole configuration of a node: its defaults, and over them what was said; and all of it as text.

use crate::kind::Kind;
use crate::plan::Plan;
use crate::section::refuse_unknown;
use crate::setting::{Origin, Setting, Settings, Value, to_json};
use anyhow::{Result, bail};
use serde::de::DeserializeOwned;
use serde_json::Value as Json;
use std::fmt::Write as _;

/// The configuration of one node. Unknown keys are refused, paths are made independent of the file that said them, and
/// the kind's own rules are asked. What stands by default enters the plan's settings, to be printed.
pub(crate) fn effective(plan: &mut Plan, name: &str, said: Option<&Setting>, kind: Option<&Kind>) -> Result<Json> {
    let mut said = match said {
        None => Settings::new(),
        Some(Setting { value: Value::Table(table), .. }) => table.clone(),
        Some(Setting { origin, .. }) => bail!("{origin}: nodes.{name}.config is a table"),
    };
    let Some(kind) = kind else {
        return Ok(to_json(&Setting { origin: Origin::Default, value: Value::Table(said) }));
    };
    take_rig(plan, &mut said, &(kind.defaults)());
    let whole = complete(kind, &format!("nodes.{name}.config"), &mut said)?;
    plan.settings_show_node(name, said, &whole);
    Ok(whole)
}

/// The configuration of a kind for a command that works on files: defaults, and over them `key=value` arguments.
pub(crate) fn of_kind<C: DeserializeOwned>(name: &str, sets: &[String]) -> Result<C> {
    let Some(kind) = crate::nodes::find(name) else { bail!("this limn has no {name}") };
    let mut settings = crate::file::defaults(&format!("[nodes.{name}.config]"))?;
    for argument in sets {
        crate::set::apply(&mut settings, &format!("{name}.{argument}"))?;
    }
    let mut said = Settings::new();
    for key in ["nodes", name, "config"] {
        if let Some(Setting { value: Value::Table(inner), .. }) = settings.remove(key) {
            said = inner.clone();
            settings = inner;
        }
    }
    Ok(C::deserialize(complete(kind, name, &mut said)?)?)
}

fn complete(kind: &Kind, path: &str, said: &mut Settings) -> Result<Json> {
    let mut whole = (kind.defaults)();
    refuse_unknown_below(path, said, &whole)?;
    for key in kind.paths {
        if let Some(Setting { origin, value: Value::Leaf(toml::Value::String(path)) }) = said.get_mut(*key) {
            // An empty path is none.
            if !path.is_empty() {
                *path = origin.folder().join(&*path).to_string_lossy().into_owned();
            }
        }
    }
    overlay(&mut whole, said);
    match (kind.check)(&whole) {
        Ok(()) => Ok(whole),
        Err(reason) => bail!("{}{path}: {reason}", blame(said, &reason)),
    }
}

/// A node that has a `rig` and was not told which takes the launch file's.
fn take_rig(plan: &Plan, said: &mut Settings, defaults: &Json) {
    let (Some(_), Some(Setting { value: Value::Table(rig), .. })) = (&plan.rig_file, plan.settings.get("rig")) else {
        return;
    };
    if let (Some(origin), Some(_)) = (rig.get("file").map(|file| &file.origin), defaults.get("rig")) {
        // As that file said it: a relative path starts from there.
        let value = rig["file"].value.clone();
        said.entry("rig".to_owned()).or_insert_with(|| Setting { origin: origin.clone(), value });
    }
}

fn refuse_unknown_below(path: &str, said: &Settings, defaults: &Json) -> Result<()> {
    // A table that is empty or unset by default does not tell its keys; the kind's own check reads them.
    let Some(known) = defaults.as_object().filter(|known| !known.is_empty()) else { return Ok(()) };
    let names: Vec<&str> = known.keys().map(String::as_str).collect();
    refuse_unknown(path, Some(said), &names)?;
    for (key, setting) in said {
        if let Value::Table(inner) = &setting.value {
            refuse_unknown_below(&format!("{path}.{key}"), inner, &known[key])?;
        }
    }
    Ok(())
}

fn overlay(base: &mut Json, over: &Settings) {
    for (key, setting) in over {
        match (&setting.value, base.get_mut(key)) {
            (Value::Table(inner), Some(below)) if below.is_object() => overlay(below, inner),
            _ => base[key.as_str()] = to_json(setting),
        }
    }
}

/// The place of the value that a refusal most likely speaks of: the longest key that its text names.
fn blame(said: &Settings, reason: &str) -> String {
    fn named<'a>(said: &'a Settings, reason: &str, best: &mut Option<(usize, &'a Origin)>) {
        for (key, setting) in said {
            if reason.contains(key.as_str()) && best.is_none_or(|(length, _)| key.len() > length) {
                *best = Some((key.len(), &setting.origin));
            }
            if let Value::Table(inner) = &setting.value {
                named(inner, reason, best);
            }
        }
    }
    let mut best = None;
    named(said, reason, &mut best);
    best.map_or_else(String::new, |(_, origin)| format!("{origin}: "))
}

impl Plan {
    /// Lets the settings show a node's whole configuration.
    fn settings_show_node(&mut self, name: &str, said: Settings, whole: &Json) {
        if let Some(node) = self.settings_of_node(name) {
            let mut table = defaults_as_settings(whole);
            crate::setting::merge(&mut table, said);
            let setting = Setting { origin: Origin::Default, value: Value::Table(table) };
            node.insert("config".to_owned(), setting);
        }
    }

    /// Lets the settings forget a node that is left out.
    pub(crate) fn settings_drop_node(&mut self, name: &str) {
        if let Some(Setting { value: Value::Table(nodes), .. }) = self.settings.get_mut("nodes") {
            nodes.remove(name);
        }
    }

    fn settings_of_node(&mut self, name: &str) -> Option<&mut Settings> {
        let Value::Table(nodes) = &mut self.settings.get_mut("nodes")?.value else { return None };
        let Value::Table(node) = &mut nodes.get_mut(name)?.value else { return None };
        Some(node)
    }

    /// The effective configuration as TOML, with the origin of each value behind it.
    pub fn to_toml(&self) -> String {
        let mut text = format!("# The effective configuration of {:?}, and where each value was said.\n", self.name);
        write_table(&mut text, "", &self.settings);
        text
    }
}

fn defaults_as_settings(json: &Json) -> Settings {
    let Json::Object(map) = json else { return Settings::new() };
    map.iter()
        .filter_map(|(key, value)| {
            let value = match value {
                Json::Object(_) => Value::Table(defaults_as_settings(value)),
                other => Value::Leaf(toml::Value::try_from(other).ok()?),
            };
            Some((key.clone(), Setting { origin: Origin::Default, value }))
        })
        .collect()
}

fn write_table(text: &mut String, path: &str, table: &Settings) {
    let leaf = |setting: &Setting| matches!(setting.value, Value::Leaf(_));
    if !path.is_empty() && (table.is_empty() || table.values().any(leaf)) {
        let _ = write!(text, "\n[{path}]\n");
    }
    for (key, setting) in table {
        if let Value::Leaf(value) = &setting.value {
            let line = format!("{} = {value}", quoted(key));
            let _ = writeln!(text, "{line:<60} # {}", setting.origin);
        }
    }
    for (key, setting) in table {
        if let Value::Table(inner) = &setting.value {
            let key = quoted(key);
            write_table(text, &if path.is_empty() { key } else { format!("{path}.{key}") }, inner);
        }
    }
}

fn quoted(key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { key.to_owned() } else { toml::Value::String(key.to_owned()).to_string() }
}
