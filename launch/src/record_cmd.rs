//! `limn record FILE`: a recorder beside a rig that is up.

use crate::live::WhichRig;
use crate::log;
use crate::process::{Process, Start};
use crate::scan_folder;
use crate::stop::Rung;
use anyhow::{Context as _, Result, bail};
use clap::ValueEnum;
use kit::NodeSpec;
use std::path::{Path, PathBuf};
use tokio::signal::ctrl_c;
use tokio::sync::watch;

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn record scan.mcap                     until Ctrl-C
  limn record scan.mcap --pictures all      laser-lit pictures as well, so that stripes can be found again
  limn record scan --as-folder              pictures and tables in the folder `scan` (and scan.mcap)";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The recording (MCAP); one that exists is not overwritten.
    pub file: PathBuf,
    /// Which pictures to keep.
    #[arg(long, value_enum, default_value_t)]
    pub pictures: Pictures,
    /// Make a scan folder of the recording when it ends; FILE names the folder.
    #[arg(long)]
    pub as_folder: bool,
    #[command(flatten)]
    rig: WhichRig,
}

/// As the recorder knows them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Pictures {
    /// Those that the lamp lit; the stripes stand for the rest.
    #[default]
    Lamp,
    /// All of them.
    All,
}

/// Records until Ctrl-C.
pub fn run(args: &Args) -> Result<()> {
    let recording = if args.as_folder { args.file.with_extension("mcap") } else { args.file.clone() };
    let pictures = if args.as_folder { Pictures::All } else { args.pictures };
    let start = start(args, &recording, pictures)?;
    let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build()?;
    runtime.block_on(until_interrupted(&start))?;
    if args.as_folder {
        scan_folder::unpack(&recording, &args.file)?;
    }
    Ok(())
}

fn start(args: &Args, recording: &Path, pictures: Pictures) -> Result<Start> {
    let rig = args.rig.find()?;
    if recording.exists() {
        bail!("{} exists already", recording.display());
    }
    let instance = format!("by_hand_{}", std::process::id());
    let mut spec = NodeSpec::new("record", &instance, rig.bus);
    let pictures = if pictures == Pictures::All { "all" } else { "lamp" };
    spec.config = serde_json::json!({ "file": recording, "pictures": pictures });
    let program = std::env::current_exe()?.to_string_lossy().into_owned();
    Ok(Start {
        name: "record".to_owned(),
        command: [&program, "node", "record", "--instance", &instance].map(str::to_owned).to_vec(),
        spec,
    })
}

async fn until_interrupted(start: &Start) -> Result<()> {
    let sink = log::to_stderr(start.name.len());
    let rung = watch::Sender::new(Rung::Run);
    let mut process = Process::start(start, rung.subscribe(), &sink)?;
    tracing::info!("recording; Ctrl-C ends it");
    let mut watched = rung.subscribe();
    let mut ended = std::pin::pin!(process.wait(&mut watched));
    let status = tokio::select! {
        status = &mut ended => status,
        interrupt = ctrl_c() => {
            interrupt.context("taking Ctrl-C")?;
            rung.send_replace(Rung::Close);
            ended.await
        }
    }?;
    if status.success() { Ok(()) } else { bail!("the recorder failed: {status}") }
}
