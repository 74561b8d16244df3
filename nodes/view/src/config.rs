//! How the page is served, and how much is shown.

use serde::{Deserialize, Serialize};
use std::net::IpAddr;

/// Defaults show everything at a calm rate, on loopback.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// Where the page and its data are served.
    pub bind: String,
    /// The page's port; 0 takes 9090, or any free one when that is taken.
    pub web_port: u16,
    /// The data's port; 0 takes 9876, or any free one when that is taken.
    pub data_port: u16,
    /// Serve the page; otherwise only its data, for a Rerun viewer that is open elsewhere.
    pub page: bool,
    /// Write everything into this .rrd file instead of serving it.
    pub save: Option<String>,
    /// What the page's data may take here; the oldest goes first.
    pub memory_mib: u64,
    /// Pictures a second at most.
    pub pictures_per_s: f64,
    /// Pictures are shrunk to at most this many pixels across.
    pub picture_width_px: u32,
    /// Refreshes of cloud and surface a second at most.
    pub surfaces_per_s: f64,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            bind: "127.0.0.1".to_owned(),
            web_port: 0,
            data_port: 0,
            page: true,
            save: None,
            memory_mib: 512,
            pictures_per_s: 8.0,
            picture_width_px: 640,
            surfaces_per_s: 1.0,
        }
    }
}

/// What cannot be shown.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// Not an address.
    #[error("view: bind = {0:?} is no IP address; 127.0.0.1 serves this machine alone")]
    Bind(String),
    /// Not a rate.
    #[error("view: {name} = {value}: more than 0 and at most 100 a second")]
    Rate {
        /// The key.
        name: &'static str,
        /// Its value.
        value: f64,
    },
}

impl Config {
    /// Refuses addresses and rates that cannot be.
    pub fn check(&self) -> Result<(), ConfigError> {
        self.bind.parse::<IpAddr>().map_err(|_| ConfigError::Bind(self.bind.clone()))?;
        for (name, value) in [("pictures_per_s", self.pictures_per_s), ("surfaces_per_s", self.surfaces_per_s)] {
            if !(value > 0.0 && value <= 100.0) {
                return Err(ConfigError::Rate { name, value });
            }
        }
        Ok(())
    }
}
