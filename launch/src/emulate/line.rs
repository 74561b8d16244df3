//! What is wrong with the line of an emulated device.

use anyhow::{Result, ensure};
use serial_line::FaultsConfig;

/// Nothing, when nothing is said.
#[derive(Debug, clap::Args)]
pub struct LineArgs {
    /// So many of a million bytes have a bit turned over.
    #[arg(long, value_name = "PPM", default_value_t = 0)]
    pub bit_errors: u32,
    /// So many of a million bytes do not arrive.
    #[arg(long, value_name = "PPM", default_value_t = 0)]
    pub lost_bytes: u32,
    /// Before so many of a million records come up to 64 bytes of anything.
    #[arg(long, value_name = "PPM", default_value_t = 0)]
    pub garbage: u32,
    /// Bytes arrive late by up to so many milliseconds.
    #[arg(long, value_name = "MS", default_value_t = 0.0)]
    pub jitter: f64,
    /// The line is cut every so many seconds.
    #[arg(long, value_name = "S", requires = "cut_for")]
    pub cut_every: Option<f64>,
    /// It stays cut for so many seconds: nothing passes, either way.
    #[arg(long, value_name = "S", requires = "cut_every")]
    pub cut_for: Option<f64>,
}

impl LineArgs {
    /// As the line knows it; the same seed gives the same faults.
    pub fn faults(&self, seed: u64) -> Result<FaultsConfig> {
        let (every_s, for_s) = (self.cut_every.unwrap_or(0.0), self.cut_for.unwrap_or(0.0));
        ensure!((0.0..=1e6).contains(&every_s), "--cut-every {every_s}: 0 to 1000000 s");
        ensure!((0.0..=every_s).contains(&for_s), "--cut-for {for_s}: 0 s to the time of --cut-every");
        ensure!((0.0..=10_000.0).contains(&self.jitter), "--jitter {}: 0 to 10000 ms", self.jitter);
        Ok(FaultsConfig {
            seed,
            jitter_nanos: (self.jitter * 1e6) as i64,
            flipped_ppm: self.bit_errors,
            lost_ppm: self.lost_bytes,
            garbage_ppm: self.garbage,
            cut_every_nanos: (every_s * 1e9) as i64,
            cut_for_nanos: (for_s * 1e9) as i64,
        })
    }
}
