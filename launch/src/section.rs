//! One table of the launch file, read key by key: what is unknown or of the wrong type is refused where it was said.

use crate::nearest::nearest;
use crate::setting::{Origin, Setting, Settings, Value};
use anyhow::{Result, anyhow, bail};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A table whose keys are all known.
pub struct Section<'a> {
    path: String,
    settings: Option<&'a Settings>,
}

impl<'a> Section<'a> {
    /// The table at `path` (as people write it: `nodes.camera`); one that is not there reads as empty.
    pub fn new(path: &str, setting: Option<&'a Setting>, known: &[&str]) -> Result<Self> {
        let settings = match setting {
            None => None,
            Some(Setting { value: Value::Table(table), .. }) => Some(table),
            Some(Setting { origin, .. }) => bail!("{origin}: {path} is a table, say [{path}]"),
        };
        refuse_unknown(path, settings, known)?;
        Ok(Self { path: path.to_owned(), settings })
    }

    /// The value of a key, if it was said.
    pub fn get(&self, key: &str) -> Option<&'a Setting> {
        self.settings.and_then(|settings| settings.get(key))
    }

    /// Where a key was said.
    pub fn origin(&self, key: &str) -> Origin {
        self.get(key).map_or(Origin::Default, |setting| setting.origin.clone())
    }

    fn leaf<T>(&self, key: &str, wanted: &str, read: impl Fn(&toml::Value) -> Option<T>) -> Result<Option<T>> {
        let Some(setting) = self.get(key) else { return Ok(None) };
        let value = match &setting.value {
            Value::Leaf(leaf) => read(leaf),
            Value::Table(_) => None,
        };
        match value {
            Some(value) => Ok(Some(value)),
            None => bail!("{}: {}.{key} takes {wanted}", setting.origin, self.path),
        }
    }

    /// A text.
    pub fn text(&self, key: &str) -> Result<Option<String>> {
        self.leaf(key, "a text", |leaf| leaf.as_str().map(str::to_owned))
    }

    /// One of a few words.
    pub fn word<T: Copy>(&self, key: &str, words: &[(&str, T)]) -> Result<Option<T>> {
        let Some(text) = self.text(key)? else { return Ok(None) };
        if let Some((_, value)) = words.iter().find(|(word, _)| *word == text) {
            return Ok(Some(*value));
        }
        let known: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        bail!("{}: {}.{key} = {text:?}{}", self.origin(key), self.path, nearest(&text, &known))
    }

    /// true or false.
    pub fn truth(&self, key: &str) -> Result<Option<bool>> {
        self.leaf(key, "true or false", toml::Value::as_bool)
    }

    /// A whole number that is not negative.
    pub fn count(&self, key: &str) -> Result<Option<u64>> {
        self.leaf(key, "a whole number from 0 up", |leaf| leaf.as_integer().and_then(|n| u64::try_from(n).ok()))
    }

    /// Seconds, not negative and not for ever.
    pub fn seconds(&self, key: &str) -> Result<Option<f64>> {
        self.leaf(key, "seconds, from 0 to 100000", |leaf| {
            let seconds = leaf.as_float().or_else(|| leaf.as_integer().map(|n| n as f64))?;
            (0.0..=1e5).contains(&seconds).then_some(seconds)
        })
    }

    /// What has to be said, by default or by the launch file.
    pub fn must<T>(&self, key: &str, value: Option<T>) -> Result<T> {
        value.ok_or_else(|| anyhow!("{}.{key} is missing", self.path))
    }

    /// A list of texts.
    pub fn texts(&self, key: &str) -> Result<Option<Vec<String>>> {
        self.leaf(key, "a list of texts", |leaf| {
            leaf.as_array()?.iter().map(|item| item.as_str().map(str::to_owned)).collect()
        })
    }

    /// A path; a relative one starts from the folder of the file that says it.
    pub fn path(&self, key: &str) -> Result<Option<PathBuf>> {
        Ok(self.text(key)?.map(|text| self.origin(key).folder().join(text)))
    }

    /// A table of texts under any keys.
    pub fn text_table(&self, key: &str) -> Result<BTreeMap<String, String>> {
        let Some(setting) = self.get(key) else { return Ok(BTreeMap::new()) };
        let Value::Table(table) = &setting.value else {
            bail!("{}: {}.{key} is a table", setting.origin, self.path);
        };
        let path = format!("{}.{key}", self.path);
        let inner = Self { path, settings: Some(table) };
        table
            .keys()
            .filter_map(|name| inner.text(name).map(|text| text.map(|t| (name.clone(), t))).transpose())
            .collect()
    }
}

/// Refuses a key that nobody reads, naming the nearest one that somebody does.
pub fn refuse_unknown(path: &str, settings: Option<&Settings>, known: &[&str]) -> Result<()> {
    for (key, setting) in settings.into_iter().flatten() {
        if !known.contains(&key.as_str()) {
            let place = if path.is_empty() { String::new() } else { format!(" in [{path}]") };
            bail!("{}: unknown key {key:?}{place}{}", setting.origin, nearest(key, known));
        }
    }
    Ok(())
}
