//! One scan through a plan, from the first node to the last file, watched all the way: `limn demo` and `limn model`.

mod account;
mod bars;
pub mod before;
pub mod evidence;
mod harvest;
mod listen;
mod parts;
mod standing;

pub use harvest::Harvest;
pub use standing::Standing;

use crate::launcher::{Launcher, Options};
use crate::log::{self, Line, Sink};
use crate::operator::Order;
use crate::plan::Plan;
use crate::running;
use crate::up::Interrupts;
use anyhow::{Context as _, Result, anyhow, bail};
use bars::Bars;
use listen::Listener;
use std::fs::File;
use std::io::Write as _;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use wire::LogLevel;

/// How to run.
pub struct Course<'a> {
    /// Where the log goes.
    pub out: &'a Path,
    /// What the bar of the sweep counts to; unknown for a recording.
    pub sweep_s: Option<f64>,
    /// Keep the rig up behind a scan that went well, so that its page can be looked at.
    pub linger: bool,
}

/// One scan that has passed.
pub struct Passed {
    /// What was gathered, whatever failed.
    pub harvest: Harvest,
    /// What failed.
    pub outcome: Result<()>,
    /// The rig, when it was to linger and all went well.
    pub standing: Option<Standing>,
}

/// Starts the plan and lets one scan pass through. A failure does not throw away the rest.
pub fn run(plan: Plan, course: &Course<'_>) -> Result<Passed> {
    let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build()?;
    let (harvest, outcome, rig) = runtime.block_on(pass(plan, course))?;
    let standing = match rig {
        Some(rig) => Some(Standing::new(runtime, rig)),
        None => {
            runtime.shutdown_background();
            None
        }
    };
    Ok(Passed { harvest, outcome, standing })
}

async fn pass(plan: Plan, course: &Course<'_>) -> Result<(Harvest, Result<()>, Option<standing::Rig>)> {
    let bars = Bars::new(course.sweep_s, &plan);
    let sink = sink(&course.out.join("log.txt"), &bars)?;
    let options = Options { executable: std::env::current_exe()?, machine: None, sink };
    let mut interrupts = Interrupts::open()?;
    bars.starting(plan.nodes.len());
    let launcher = Launcher::start(plan, options).await?;
    // For `limn top` and its like. Two demos may well run at once: only one of them is found.
    let announced =
        running::folder().and_then(|folder| running::announce(&folder, &launcher.plan().name, launcher.bus()));
    if let Err(error) = &announced {
        tracing::warn!("`limn top` and its like will not find this rig: {error:#}");
    }
    let listener = Listener::start(launcher.bus(), launcher.plan(), bars.clone())?;
    let outcome = tokio::select! {
        outcome = course_of(&launcher, &bars) => outcome,
        () = interrupts.next() => Err(anyhow!("interrupted")),
    };
    let mut rig = standing::Rig { launcher, interrupts, announced: announced.ok() };
    let lingers = course.linger && outcome.is_ok();
    if !lingers {
        rig.stop().await;
    }
    let outcome = outcome.and_then(|()| rig.launcher.check());
    let harvest = tokio::task::spawn_blocking(move || listener.finish()).await?;
    bars.done();
    let outcome = outcome.and_then(|()| harvest.emptiness().map_or(Ok(()), |why| Err(anyhow!(why))));
    if lingers && outcome.is_err() {
        rig.stop().await;
    }
    let stands = lingers && outcome.is_ok();
    Ok((harvest, outcome, stands.then_some(rig)))
}

async fn course_of(launcher: &Launcher, bars: &Bars) -> Result<()> {
    launcher.wait_ready().await?;
    bars.sweeping();
    let Some(order) = Order::beginning(launcher.plan().run.begin) else {
        bail!("[run] begin is \"aim\": nobody would ever start this scan");
    };
    launcher.order(order);
    launcher.wait_ended().await
}

/// Everything goes into the file; errors, warnings and the page's address also to the terminal.
fn sink(path: &Path, bars: &Bars) -> Result<Sink> {
    let file = Mutex::new(File::create(path).with_context(|| format!("writing the log {}", path.display()))?);
    let bars = bars.clone();
    Ok(Arc::new(move |line: &Line| {
        let text = log::format(line, 12, false);
        // A full disk must not stop the scan.
        let _ = writeln!(file.lock().unwrap_or_else(PoisonError::into_inner), "{text}");
        if matches!(line.level, LogLevel::Error | LogLevel::Warn) || line.text.starts_with("look: ") {
            bars.say(&text);
        }
    }))
}
