//! One scan through a plan, from the first node to the last file, watched all the way: `limn demo` and `limn model`.

mod account;
mod bars;
pub mod before;
mod harvest;
mod listen;

pub use harvest::Harvest;

use crate::launcher::{Launcher, Options};
use crate::log::{self, Line, Sink};
use crate::operator::Order;
use crate::plan::Plan;
use crate::running;
use anyhow::{Context as _, Result, bail};
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
    /// Keep the rig up until Ctrl-C when the scan is done, so that its page can be looked at.
    pub linger: bool,
}

/// Starts the plan, lets one scan pass through, and stops it. What was gathered is returned together with what failed:
/// a failure does not throw away the rest.
pub fn run(plan: Plan, course: &Course<'_>) -> Result<(Harvest, Result<()>)> {
    let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build()?;
    let outcome = runtime.block_on(pass(plan, course));
    runtime.shutdown_background();
    outcome
}

async fn pass(plan: Plan, course: &Course<'_>) -> Result<(Harvest, Result<()>)> {
    let bars = Bars::new(course.sweep_s);
    let sink = sink(&course.out.join("log.txt"), &bars)?;
    let options = Options { executable: std::env::current_exe()?, machine: None, sink };
    bars.starting(plan.nodes.len());
    let mut launcher = Launcher::start(plan, options).await?;
    // For `limn top` and its like. Two demos may well run at once: only one of them is found.
    let announced =
        running::folder().and_then(|folder| running::announce(&folder, &launcher.plan().name, launcher.bus()));
    if let Err(error) = &announced {
        tracing::warn!("`limn top` and its like will not find this rig: {error:#}");
    }
    let listener = Listener::start(launcher.bus(), launcher.plan(), bars.clone())?;
    let interrupted = tokio::signal::ctrl_c();
    let outcome = tokio::select! {
        outcome = course_of(&launcher, &bars) => outcome,
        _ = interrupted => Err(anyhow::anyhow!("interrupted")),
    };
    if course.linger && outcome.is_ok() {
        bars.say("done; the page stays up until Ctrl-C");
        let _ = tokio::signal::ctrl_c().await;
    }
    drop(announced);
    launcher.stop().await;
    let outcome = outcome.and_then(|()| launcher.check());
    let harvest = tokio::task::spawn_blocking(move || listener.finish()).await?;
    bars.done();
    let outcome = outcome.and_then(|()| harvest.emptiness().map_or(Ok(()), |why| Err(anyhow::anyhow!(why))));
    Ok((harvest, outcome))
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
