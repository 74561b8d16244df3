//! Where the files go.

use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The choices of the exporter.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Made when it is not there; files in it are replaced. Default "out".
    pub folder: PathBuf,
}

impl Default for Config {
    fn default() -> Self {
        Self { folder: "out".into() }
    }
}

/// A choice that cannot be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ConfigError {
    /// No folder.
    #[error("folder = \"\": name a folder for the files")]
    Folder,
}

impl Config {
    /// Refuses an empty name.
    pub fn check(&self) -> Result<(), ConfigError> {
        if self.folder.as_os_str().is_empty() { Err(ConfigError::Folder) } else { Ok(()) }
    }
}
