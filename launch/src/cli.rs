//! The command line.

use crate::operator::Order;
use crate::{
    cluster_cmd, compare_cmd, demo, echo, emulate, hz, live, model_cmd, record_cmd, refine_cmd, replay_cmd, scan,
    stripe_cmd, surface_cmd, top, topics, up,
};
use anyhow::Result;
#[cfg(feature = "v4l")]
use camera_v4l::inspect;
use clap::{Args, Parser, Subcommand};
#[cfg(not(feature = "v4l"))]
use devices::not_built_in as inspect;
use std::path::{Path, PathBuf};

/// An inverse paintbrush: sweep a camera, a line laser and a lamp over a thing, and its shape and colour appear.
#[derive(Debug, Parser)]
#[command(name = "limn", version, propagate_version = true, max_term_width = 110)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// See it work: a simulated hand scans a thing that is known exactly, and the result is held against it.
    #[command(after_help = demo::HELP)]
    Demo(demo::Args),
    /// Make a model from a recording or a scan folder.
    #[command(after_help = model_cmd::HELP)]
    Model(model_cmd::Args),
    /// Refine the camera's way of a recording, and tell what is known of it.
    #[command(after_help = refine_cmd::HELP)]
    Refine(refine_cmd::Args),
    /// Start a rig from a launch file, and stop it with Ctrl-C.
    #[command(after_help = up::HELP)]
    Up(up::Args),
    /// Tell a rig that is up what the operator does: the same as the keys s, c, b, e, d in `limn up`.
    #[command(after_help = scan::HELP)]
    Scan {
        /// What to do.
        order: Order,
        /// Where.
        #[command(flatten)]
        rig: live::WhichRig,
    },
    /// Show the nodes of a rig that is up: rates, latency, losses.
    Top(live::WhichRig),
    /// List the topics, and what a rig that is up sends on them.
    Topics(live::WhichRig),
    /// Print the messages of a topic.
    #[command(after_help = echo::HELP)]
    Echo(echo::Args),
    /// Measure how often messages come on a topic, how large they are, and how many are missing.
    Hz(hz::Args),
    /// Print who feeds whom in a launch file.
    Graph {
        /// What to read.
        #[command(flatten)]
        launch: LaunchFile,
        /// For Graphviz: `limn graph FILE --dot | dot -Tsvg > graph.svg`.
        #[arg(long)]
        dot: bool,
    },
    /// Print the effective configuration of a launch file, and where each value was said.
    #[command(after_help = CONFIG_HELP)]
    Config(LaunchFile),
    /// Record what a rig that is up sends.
    #[command(after_help = record_cmd::HELP)]
    Record(record_cmd::Args),
    /// Play a recording or a scan folder through a pipeline.
    #[command(after_help = replay_cmd::HELP)]
    Replay(replay_cmd::Args),
    /// List the cameras and serial ports of this machine, and what keeps you from them.
    Devices,
    /// Play a tracker byte for byte at the end of a serial line, watching the simulated hand.
    #[command(after_help = emulate::HELP)]
    Emulate(emulate::Args),
    /// Find the laser's stripe in a picture.
    #[command(after_help = stripe_cmd::HELP)]
    Stripe(stripe_cmd::Args),
    /// Thin points to a cloud of balls, as the paper does.
    #[command(after_help = cluster_cmd::HELP)]
    Cluster(cluster_cmd::Args),
    /// Lay a surface through a cloud.
    #[command(after_help = surface_cmd::HELP)]
    Surface(surface_cmd::Args),
    /// Compare a model with the truth, both ways, by distances to triangles.
    #[command(after_help = compare_cmd::HELP)]
    Compare(compare_cmd::Args),
    /// Live as one node: what `limn up` starts. Reads its configuration as one line of JSON on standard input.
    #[command(after_help = node_help())]
    Node {
        /// What it does.
        kind: String,
        /// Which one of its kind.
        #[arg(long, default_value = crate::kind::DEFAULT_INSTANCE)]
        instance: String,
    },
}

const CONFIG_HELP: &str = "Examples:
  limn config launch/demo.toml
  limn config launch/demo.toml --set stripe.min_amplitude=12 --set run.pace=fast
The last word wins: defaults in the code, what the launch file includes, the launch file, --set.";

/// A launch file and what is laid on it.
#[derive(Debug, Clone, Args)]
pub struct LaunchFile {
    /// The launch file (TOML).
    pub file: PathBuf,
    /// Overrule one value: NODE.KEY=VALUE for a node's configuration, or SECTION.KEY=VALUE. May come again.
    #[arg(long = "set", value_name = "NODE.KEY=VALUE")]
    pub sets: Vec<String>,
}

impl LaunchFile {
    /// Reads and checks it; what is odd is told on standard error.
    pub fn load(&self) -> Result<crate::plan::Plan> {
        let plan = crate::plan::Plan::load(&self.file, &self.sets, crate::nodes::KINDS)?;
        plan.warnings.iter().for_each(|warning| tracing::warn!("{warning}"));
        Ok(plan)
    }
}

fn node_help() -> String {
    let kinds = crate::nodes::KINDS.iter().map(|kind| format!("\n  {:<14} {}", kind.name, kind.about));
    format!("Kinds:{}", kinds.collect::<String>())
}

/// Does what the command line says.
pub fn run(cli: Cli) -> Result<()> {
    match cli.command {
        Command::Node { kind, instance } => return crate::node_cmd::run(&kind, &instance),
        _ => start_log(),
    }
    match cli.command {
        Command::Demo(args) => demo::run(&args),
        Command::Model(args) => model_cmd::run(&args),
        Command::Refine(args) => refine_cmd::run(&args),
        Command::Devices => live::print(&devices::list(Path::new("/"), inspect).to_string()),
        Command::Emulate(args) => emulate::run(&args),
        Command::Up(args) => up::run(&args),
        Command::Scan { order, rig } => scan::run(order, &rig),
        Command::Top(rig) => top::run(&rig),
        Command::Topics(rig) => topics::run(&rig),
        Command::Echo(args) => echo::run(&args),
        Command::Hz(args) => hz::run(&args),
        Command::Graph { launch, dot } => {
            let plan = launch.load()?;
            live::print(&if dot { crate::graph::dot(&plan) } else { crate::graph::text(&plan) })
        }
        Command::Config(launch) => live::print(&launch.load()?.to_toml()),
        Command::Record(args) => record_cmd::run(&args),
        Command::Replay(args) => replay_cmd::run(&args),
        Command::Stripe(args) => stripe_cmd::run(&args),
        Command::Cluster(args) => cluster_cmd::run(&args),
        Command::Surface(args) => surface_cmd::run(&args),
        Command::Compare(args) => compare_cmd::run(&args),
        Command::Node { .. } => Ok(()),
    }
}

/// The launcher's and the commands' own log; a node has its own.
fn start_log() {
    use std::io::IsTerminal as _;
    let filter = tracing_subscriber::EnvFilter::new("warn,zenoh=error,limn=info");
    let log = tracing_subscriber::fmt().with_env_filter(filter).with_writer(std::io::stderr).without_time();
    let _ = log.with_target(false).with_ansi(std::io::stderr().is_terminal()).try_init();
}
