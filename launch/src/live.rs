//! The way to a rig that is up, for the commands that look at it.

use crate::running::{self, Running};
use anyhow::Result;
use bus::{Bus, BusConfig};
use clap::Args;
use std::io::Write as _;

/// Which of the rigs that are up.
#[derive(Debug, Clone, Args)]
pub struct WhichRig {
    /// The stem of its launch file; needed only when several rigs are up.
    #[arg(long = "rig", value_name = "NAME")]
    pub name: Option<String>,
}

impl WhichRig {
    /// Finds it among those that are up.
    pub fn find(&self) -> Result<Running> {
        running::find(&running::folder()?, self.name.as_deref())
    }

    /// Finds it and joins its bus.
    pub fn open(&self) -> Result<(Running, Bus)> {
        let rig = self.find()?;
        // Somebody may stop it by Ctrl-Z.
        let bus = Bus::open(&BusConfig { onlooker: true, ..rig.bus.clone() })?;
        Ok((rig, bus))
    }
}

/// Prints text. A reader that has seen enough (`limn echo ... | head`) ends the command in peace.
pub fn print(text: &str) -> Result<()> {
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => std::process::exit(0),
        other => Ok(other?),
    }
}
