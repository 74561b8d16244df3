//! How a recording is cut and packed.

use serde::{Deserialize, Serialize};

/// The numbers of a recording.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct Config {
    /// A chunk is closed when it holds this much. Default 8: two pictures of 1280x1024 in colour.
    pub chunk_mb: u32,
    /// A chunk is closed when its messages span this much time, so that a crash loses no more. Default 1.
    pub chunk_s: f64,
    /// 0 does not compress, 1 (fast) to 19 (small). Default 0: noisy pictures of 1280x1024 in colour shrink to 0.81 at level
    /// 1 and to 0.71 at level 3, and take 4 and 20 times as long (`cargo bench -p record`), on cores that others need.
    pub zstd_level: u32,
}

impl Default for Config {
    fn default() -> Self {
        Self { chunk_mb: 8, chunk_s: 1.0, zstd_level: 0 }
    }
}

/// A number out of its range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConfigError {
    /// Size of a chunk.
    #[error("chunk_mb = {0}: 1 to 256")]
    Size(u32),
    /// Time in a chunk.
    #[error("chunk_s = {0}: 0.01 to 60")]
    Time(f64),
    /// Effort.
    #[error("zstd_level = {0}: 0 to 19")]
    Level(u32),
}

impl Config {
    /// Refuses numbers out of range.
    pub fn check(&self) -> Result<(), ConfigError> {
        if !(1..=256).contains(&self.chunk_mb) {
            return Err(ConfigError::Size(self.chunk_mb));
        }
        if !(0.01..=60.0).contains(&self.chunk_s) {
            return Err(ConfigError::Time(self.chunk_s));
        }
        if self.zstd_level > 19 {
            return Err(ConfigError::Level(self.zstd_level));
        }
        Ok(())
    }
}
