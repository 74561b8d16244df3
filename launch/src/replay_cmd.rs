//! `limn replay FILE`: a recording or a scan folder through a pipeline.

use crate::cli::LaunchFile;
use crate::demo::files;
use crate::model_cmd::FILES;
use crate::plan::Plan;
use crate::recorded::Recorded;
use crate::running;
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
    /// The launch file that takes it, with a node named `replay`; without it, the one that is built in.
    #[arg(long, value_name = "FILE")]
    pub launch: Option<PathBuf>,
    /// Overrule one value. May come again.
    #[arg(long = "set", value_name = "NODE.KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Starts the launch file with this recording in it.
pub fn run(args: &Args) -> Result<()> {
    // What is built in is read from files as any other, so that its includes and the origins of its values are the same.
    let own = running::folder()?.join(format!("replay-{}", std::process::id()));
    let launch = match &args.launch {
        Some(launch) => launch.clone(),
        None => files::write(&own, &FILES)?,
    };
    let plan = plan(args, launch);
    if args.launch.is_none() {
        // It is read; that it stays would harm nobody.
        let _ = std::fs::remove_dir_all(&own);
    }
    up::play(plan?, None)
}

fn plan(args: &Args, launch: PathBuf) -> Result<Plan> {
    let mut sets = Recorded::look(&args.file)?.sets(&args.file, &launch)?;
    sets.extend(args.sets.iter().cloned());
    LaunchFile { file: launch, sets }.load()
}
