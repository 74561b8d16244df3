//! `limn replay FILE`: a recording or a scan folder through a pipeline.

use crate::cli::LaunchFile;
use crate::recorded::Recorded;
use crate::up;
use anyhow::Result;
use std::path::PathBuf;

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn replay scan.mcap                                     as it happened, with the settings it was recorded with
  limn replay scan.mcap --set run.pace=fast                 as fast as the machine can, with nothing lost
  limn replay ../someones/scan-folder --set export.folder=out/theirs";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recording (MCAP) or a scan folder.
    pub file: PathBuf,
    /// The launch file that takes it; it has a node named `replay`.
    #[arg(long, default_value = "launch/replay.toml", value_name = "FILE")]
    pub launch: PathBuf,
    /// Overrule one value. May come again.
    #[arg(long = "set", value_name = "NODE.KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Starts the launch file with this recording in it.
pub fn run(args: &Args) -> Result<()> {
    let mut sets = Recorded::look(&args.file)?.sets(&args.file, &args.launch)?;
    sets.extend(args.sets.iter().cloned());
    let launch = LaunchFile { file: args.launch.clone(), sets };
    up::run(&up::Args { launch, machine: None })
}
