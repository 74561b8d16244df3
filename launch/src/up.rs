//! `limn up FILE`: a rig from its first node to its last.

use crate::board::{Event, Process, Status};
use crate::cli::LaunchFile;
use crate::keys::{self, Keys};
use crate::launcher::{Launcher, Options};
use crate::log::{self, Line};
use crate::operator::Order;
use crate::plan::Plan;
use crate::running;
use crate::stop::Rung;
use crate::story::story;
use anyhow::{Context as _, Result, bail};
use tokio::signal::unix::{Signal, SignalKind, signal};
use tokio::sync::{broadcast, mpsc};
use wire::LogLevel;

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn up launch/demo.toml
  limn up launch/bench.toml --set camera.exposure_ms=4 --set nodes.view.enabled=false
  limn up launch/bench.toml --machine capture     on the machine `capture`, when it is not reached by ssh
Keys while it runs: s shape, c colour, b both, e end, d discard. Ctrl-C ends the scan and stops the nodes; again, it
hurries. `limn scan`, `limn top`, `limn echo` and the rest work from any other terminal.";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// What to start.
    #[command(flatten)]
    pub launch: LaunchFile,
    /// Start only the nodes of this machine; the router and the operator are elsewhere.
    #[arg(long, value_name = "NAME")]
    pub machine: Option<String>,
}

/// Runs the rig until the operator stops it, its scan is done (`[run] once`), or a required node has failed for good.
pub fn run(args: &Args) -> Result<()> {
    play(args.launch.load()?, args.machine.clone())
}

/// The same for a plan that is read already.
pub(crate) fn play(plan: Plan, machine: Option<String>) -> Result<()> {
    let runtime = tokio::runtime::Builder::new_multi_thread().worker_threads(2).enable_all().build()?;
    let outcome = runtime.block_on(up(plan, machine));
    // A thread may be reading the keyboard still.
    runtime.shutdown_background();
    outcome
}

/// Runs a plan as `limn up` does.
pub async fn up(plan: Plan, machine: Option<String>) -> Result<()> {
    let width = plan.nodes.iter().map(|node| node.name.len()).max().unwrap_or(0).max("limn".len());
    let sink = log::to_stderr(width);
    let mut interrupts = Interrupts::open()?;
    let say = |level, text: String| sink(&Line { node: "limn".to_owned(), level, text });
    let options = Options { executable: std::env::current_exe()?, machine: machine.clone(), sink: sink.clone() };
    let name = plan.name.clone();
    let mut launcher = Launcher::start(plan, options).await?;
    // Nothing is gathered yet: when the name is taken, the nodes may die with the launcher.
    let announce = || running::announce(&running::folder()?, &name, launcher.bus());
    let announced = machine.is_none().then(announce).transpose()?;
    let keys = Keys::open().filter(|_| machine.is_none());
    if keys.is_some() {
        say(LogLevel::Info, keys::HELP.to_owned());
    }
    let (restore, orders) = keys.map_or((None, None), |(restore, orders)| (Some(restore), Some(orders)));
    let outcome = watch(&launcher, &mut interrupts, orders, &say).await;
    if let Err(error) = &outcome {
        say(LogLevel::Error, format!("{}; stopping", story(error)));
    }
    let rung = stop(&mut launcher, &mut interrupts).await;
    if rung > Rung::Close {
        say(LogLevel::Warn, format!("a node did not stop when its standard input closed: {rung:?} was needed"));
    }
    drop((restore, announced));
    outcome.and(launcher.check())?;
    match launcher.lost() {
        0 => Ok(()),
        lost => bail!("{lost} messages lost"),
    }
}

/// Passes orders on and tells what happens, until it is time to stop.
async fn watch(
    launcher: &Launcher,
    interrupts: &mut Interrupts,
    mut orders: Option<mpsc::Receiver<Order>>,
    say: &impl Fn(LogLevel, String),
) -> Result<()> {
    let (mut events, run) = (launcher.events(), &launcher.plan().run);
    let mut course = std::pin::pin!(course(launcher));
    loop {
        tokio::select! {
            outcome = &mut course => return outcome,
            () = interrupts.next() => {
                say(LogLevel::Info, format!("stopping; the scan has {} s to finish, Ctrl-C hurries", run.end.as_secs()));
                return Ok(());
            }
            order = next(&mut orders) => launcher.order(order),
            event = events.recv() => match event {
                Ok(event) => tell(&event, &launcher.status(), say),
                Err(broadcast::error::RecvError::Lagged(missed)) => say(LogLevel::Warn, format!("{missed} events missed")),
                Err(broadcast::error::RecvError::Closed) => return Ok(()),
            },
        }
    }
}

async fn stop(launcher: &mut Launcher, interrupts: &mut Interrupts) -> Rung {
    let hurry = launcher.hurry();
    let mut stopping = std::pin::pin!(launcher.stop());
    loop {
        tokio::select! {
            rung = &mut stopping => return rung,
            () = interrupts.next() => hurry.notify_one(),
        }
    }
}

/// What a rig goes through by itself: it returns when there is nothing left to do.
async fn course(launcher: &Launcher) -> Result<()> {
    let run = launcher.plan().run.clone();
    if launcher.keeps_phase() {
        launcher.wait_ready().await?;
        if let Some(order) = Order::beginning(run.begin) {
            launcher.order(order);
        }
    }
    tokio::select! {
        ended = launcher.wait_ended(), if run.once => ended,
        failed = launcher.wait_failed() => failed,
        gone = launcher.wait_gone() => gone,
    }
}

async fn next(orders: &mut Option<mpsc::Receiver<Order>>) -> Order {
    if let Some(order) = match orders {
        Some(orders) => orders.recv().await,
        None => None,
    } {
        return order;
    }
    // No keyboard, or it was closed.
    *orders = None;
    std::future::pending().await
}

fn tell(event: &Event, status: &Status, say: &impl Fn(LogLevel, String)) {
    let elsewhere = |node: &String| status.nodes.get(node).is_some_and(|node| node.process == Process::Elsewhere);
    match event {
        Event::Ready { node } => say(LogLevel::Info, format!("{node} is ready")),
        Event::Finished { node, scan } => say(LogLevel::Info, format!("{node} has finished scan {scan}")),
        Event::Phase { scan, phase } => say(LogLevel::Info, format!("scan {scan}: {phase:?}")),
        // Of our own nodes a supervisor knows more.
        Event::Gone { node } if elsewhere(node) => say(LogLevel::Warn, format!("{node} has left the bus")),
        Event::Ended { node } => say(LogLevel::Info, format!("{node} has ended")),
        // A supervisor tells of failures itself.
        Event::Started { .. } | Event::Restarting { .. } | Event::Failed { .. } | Event::Gone { .. } => {}
    }
}

/// What a person, a service manager or a closing terminal send to stop a program.
pub(crate) struct Interrupts([Signal; 3]);

impl Interrupts {
    pub(crate) fn open() -> Result<Self> {
        let open = |kind| signal(kind).context("taking a signal");
        Ok(Self([open(SignalKind::interrupt())?, open(SignalKind::terminate())?, open(SignalKind::hangup())?]))
    }

    pub(crate) async fn next(&mut self) {
        let [interrupt, terminate, hangup] = &mut self.0;
        tokio::select! {
            _ = interrupt.recv() => {}
            _ = terminate.recv() => {}
            _ = hangup.recv() => {}
        }
    }
}
