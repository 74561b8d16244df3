//! A value of the configuration together with the place where it was said.

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where a value was said.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// In the code.
    Default,
    /// In a launch file or one that it includes.
    File {
        /// As it was named on the command line or in `include`.
        path: Arc<Path>,
        /// Counted from 1.
        line: usize,
    },
    /// On the command line: the whole `node.key=value`.
    Set(String),
}

impl Origin {
    /// The folder that a relative path said here starts from: that of the file, or the current one.
    pub fn folder(&self) -> PathBuf {
        match self {
            Self::File { path, .. } => path.parent().map_or_else(PathBuf::new, Path::to_path_buf),
            Self::Default | Self::Set(_) => PathBuf::new(),
        }
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Default => f.write_str("default"),
            Self::File { path, line } => write!(f, "{}:{line}", path.display()),
            Self::Set(argument) => write!(f, "--set {argument}"),
        }
    }
}

/// A value and its origin.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Where it was said last.
    pub origin: Origin,
    /// What was said.
    pub value: Value,
}

/// Tables are merged key by key; all else is replaced whole.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number, a text, a list, ...
    Leaf(toml::Value),
    /// Keys and values.
    Table(Settings),
}

/// A table.
pub type Settings = BTreeMap<String, Setting>;

/// Lays `over` on `base`: the last word wins.
pub fn merge(base: &mut Settings, over: Settings) {
    for (key, above) in over {
        match (base.get_mut(&key), above) {
            (Some(Setting { value: Value::Table(below), .. }), Setting { value: Value::Table(above), .. }) => {
                merge(below, above);
            }
            (_, above) => {
                base.insert(key, above);
            }
        }
    }
}

/// The same without origins. Dates have no meaning here and become text.
pub fn to_json(setting: &Setting) -> serde_json::Value {
    match &setting.value {
        Value::Leaf(leaf) => leaf_to_json(leaf),
        Value::Table(table) => table.iter().map(|(key, value)| (key.clone(), to_json(value))).collect(),
    }
}

fn leaf_to_json(leaf: &toml::Value) -> serde_json::Value {
    match leaf {
        toml::Value::String(text) => text.as_str().into(),
        toml::Value::Integer(number) => (*number).into(),
        toml::Value::Float(number) => (*number).into(),
        toml::Value::Boolean(truth) => (*truth).into(),
        toml::Value::Datetime(date) => date.to_string().into(),
        toml::Value::Array(items) => items.iter().map(leaf_to_json).collect(),
        toml::Value::Table(table) => table.iter().map(|(key, value)| (key.clone(), leaf_to_json(value))).collect(),
    }
}
