//! `limn emulate flock|polhemus`: a tracker at the end of a serial line, played byte for byte, that watches the hand of
//! the simulated world.
//!
//! It stands for a thing outside of the computer, so it is no node: no launch file names it, and the rig that listens to it
//! is started as it is with a real tracker. Of that rig it hears only when the operator begins a scan (`--follow`): that is
//! when the simulated camera's hand begins, and so this one's.

mod devices;
mod follow;
mod hand;
mod line;
mod mood;

pub use devices::Device;

use crate::live::print;
use crate::up::Interrupts;
use anyhow::{Context as _, Result};
use follow::{Begun, Follow};
use hand::{Beginning, HandArgs};
use line::LineArgs;
use serial_line::{Emulated, HostClock, Pty};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn emulate flock                                            its hand begins now
  limn emulate flock --link /tmp/limn-flock --follow emulated   its hand begins with each scan of the rig `emulated`:
  limn up launch/emulated.toml                                  in another terminal; `b` begins a scan, `e` ends it
  limn emulate flock --units 3 --first-sensor 2                 two sensors behind an extended range controller
  limn emulate flock --mood test-echo                           its switch 8 is on; --mood says what else may be wrong
  limn emulate polhemus --family patriot --cut-every 10 --cut-for 2 --bit-errors 500
The driver's port is the path that is printed, or the link. Transmitter and world share origin and axes, z up: tell the
Flock's driver hemisphere = \"lower\", the Polhemus's hemisphere = [0, 0, 1]; and scan_clock = true beside a simulated camera.";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Which tracker.
    #[command(subcommand)]
    pub device: Device,
}

/// What all devices are told.
#[derive(Debug, clap::Args)]
pub struct Common {
    /// A name that leads to its port; one that was left from before is replaced.
    #[arg(long, value_name = "PATH")]
    pub link: Option<PathBuf>,
    /// Begin the hand's sweep with each scan of the rig that is up under this name, the stem of its launch file, now or later.
    #[arg(long, value_name = "NAME")]
    pub follow: Option<String>,
    /// What it watches.
    #[command(flatten)]
    pub hand: HandArgs,
    /// What is wrong with its line.
    #[command(flatten)]
    pub line: LineArgs,
}

/// How long the line's state may go unseen.
const NAP: Duration = Duration::from_millis(50);

/// Plays the device until Ctrl-C.
pub fn run(args: &Args) -> Result<()> {
    let clock = HostClock::start();
    let beginning = Beginning::default();
    match &args.device {
        Device::Flock(flock) => play("a Flock of Birds", flock.emulator(&beginning)?, &flock.common, clock, &beginning),
        Device::Polhemus(polhemus) => {
            let about = format!("a {:?}", polhemus.family);
            play(&about, polhemus.emulator(&beginning)?, &polhemus.common, clock, &beginning)
        }
    }
}

fn play(about: &str, device: impl Emulated, common: &Common, clock: HostClock, beginning: &Beginning) -> Result<()> {
    let faults = common.line.faults(common.hand.seed)?;
    let stopping = stop_on_interrupt()?;
    let pty = Pty::start(device, faults, clock, common.link.as_deref())?;
    let port = std::fs::canonicalize(pty.path()).unwrap_or_else(|_| pty.path().to_owned());
    let link = common.link.as_ref().map(|link| format!(", which {} leads to", link.display())).unwrap_or_default();
    print(&format!("{about} is on {}{link}\n", port.display()))?;
    let mut follow = common.follow.clone().map(Follow::new);
    if follow.is_none() {
        beginning.set(clock.now_nanos());
    }
    let mut cut = false;
    while !stopping.load(Ordering::SeqCst) {
        match &mut follow {
            None => std::thread::sleep(NAP),
            Some(follow) => {
                if let Some(Begun { scan, epoch_nanos }) = follow.look(NAP)? {
                    beginning.set(clock.from_system(epoch_nanos));
                    tracing::info!("scan {scan}: the hand begins");
                }
            }
        }
        let now_cut = faults.is_cut(clock.now_nanos());
        if std::mem::replace(&mut cut, now_cut) != now_cut {
            tracing::warn!("{}", if now_cut { "the line is cut" } else { "the line is whole again" });
        }
    }
    Ok(())
}

/// True once the program was told to stop. It listens for that when this returns.
fn stop_on_interrupt() -> Result<Arc<AtomicBool>> {
    let stopping = Arc::<AtomicBool>::default();
    let told = stopping.clone();
    let (listens, listening) = std::sync::mpsc::channel();
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    std::thread::Builder::new()
        .name("interrupts".to_owned())
        .spawn(move || {
            runtime.block_on(async {
                match Interrupts::open() {
                    Ok(mut interrupts) => {
                        // Who waits for this has not gone.
                        let _ = listens.send(());
                        interrupts.next().await;
                    }
                    Err(error) => tracing::error!("{error:#}"),
                }
            });
            told.store(true, Ordering::SeqCst);
        })
        .context("a thread")?;
    // An error is no message: the thread has told it.
    let _ = listening.recv();
    Ok(stopping)
}
