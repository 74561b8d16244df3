//! `limn demo`: a simulated hand paints a thing that is known exactly, and the result is held against it.

pub(crate) mod files;
mod judge;
mod standing;
pub(crate) mod table;

use crate::nodes;
use crate::plan::Plan;
use crate::run::{self, Course, Passed};
use anyhow::{Context as _, Result, bail};
use clap::{Args as ClapArgs, ValueEnum};
use std::path::PathBuf;
use std::time::Instant;
use world::Setup;

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn demo                                    the toy cow, live, with its page
  limn demo --headless --pace fast             as fast as the machine can, nothing to look at
  limn demo --object vase.obj --size-mm 120    your own thing: OBJ, PLY, STL, GLB or glTF
  limn demo --rig fine                         a better camera, and a tracker that is right to 0.05 mm
Afterwards OUT/report.html shows the model beside the truth.";

/// How sources keep time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Pace {
    /// As a person's hand would.
    Real,
    /// As fast as the machine can, with nothing lost.
    Fast,
}

/// What is made for the eye alone is not made when nobody looks.
pub(crate) const UNSEEN: [&str; 2] = ["surface.live_every_s=0", "refine.live_every_s=0"];

/// The arguments.
#[derive(Debug, Clone, ClapArgs)]
pub struct Args {
    /// A mesh to scan instead of the cow: OBJ, PLY, STL, GLB or glTF, with texture, vertex colours or neither.
    #[arg(long, value_name = "FILE", conflicts_with = "scene")]
    pub object: Option<PathBuf>,
    /// The largest side of that mesh.
    #[arg(long, value_name = "N", default_value_t = 150.0)]
    pub size_mm: f64,
    /// A scene: `cow`, `one_way`, `tabletop`, or a scene file.
    #[arg(long, value_name = "NAME|FILE")]
    pub scene: Option<String>,
    /// A handset: `paper` (its tracker is 3 degrees wrong), `field`, `mixed`, `flock`, `rough`, `fine`, or a rig file.
    #[arg(long, value_name = "NAME|FILE", default_value = "paper")]
    pub rig: String,
    /// The seed of everything random.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// How long the hand sweeps.
    #[arg(long, value_name = "N", default_value_t = 60.0)]
    pub seconds: f64,
    /// Whether the hand keeps to the clock on the wall; without a page it need not.
    #[arg(long)]
    pub pace: Option<Pace>,
    /// No page, and no waiting at the end.
    #[arg(long)]
    pub headless: bool,
    /// Where everything is written.
    #[arg(long, value_name = "DIR", default_value = "out/demo")]
    pub out: PathBuf,
    /// Overrule one value: NODE.KEY=VALUE. May come again.
    #[arg(long = "set", value_name = "NODE.KEY=VALUE")]
    pub sets: Vec<String>,
}

impl Args {
    fn pace(&self) -> Pace {
        self.pace.unwrap_or(if self.headless { Pace::Fast } else { Pace::Real })
    }
}

/// Runs the demo. Fails when a stage failed or anything was lost; what was made is written all the same.
pub fn run(args: &Args) -> Result<()> {
    let started = Instant::now();
    std::fs::create_dir_all(&args.out).with_context(|| format!("making the folder {}", args.out.display()))?;
    let out = args.out.canonicalize()?;
    // A recording is never overwritten; that of an earlier demo is ours to remove.
    for part in formats::recording_parts(&out.join("scan.mcap")) {
        let _ = std::fs::remove_file(part);
    }
    let launch = files::lay_out(&out)?;
    let setup = Setup {
        scene: files::scene(&out, args.scene.as_deref().unwrap_or("cow")),
        object: args.object.clone().unwrap_or_default(),
        size_mm: args.size_mm,
        rig: files::rig(&out, &args.rig),
        seed: args.seed,
        seconds: args.seconds,
    };
    // What is wrong with scene, object or rig is better said now than by a node.
    let known = setup.open()?;
    let plan = Plan::load(&launch, &sets(args, &setup, &out), nodes::KINDS)?;
    std::fs::write(out.join("config.toml"), plan.to_toml()).context("writing the effective configuration")?;
    let linger = !args.headless && std::io::IsTerminal::is_terminal(&std::io::stdin());
    let course = Course { out: &out, sweep_s: Some(known.hand.duration_s()), linger };
    let Passed { harvest, outcome, standing } = run::run(plan.clone(), &course)?;
    let report = judge::judge(args, &known, &plan, &harvest, outcome.as_ref().err(), started, &out)?;
    table::print(&report, &out)?;
    if let Some(standing) = standing {
        eprintln!("\ndone; the page stays up until Ctrl-C");
        standing.stay()?;
    }
    outcome?;
    if !report.is_good() {
        bail!("{} messages lost; {} failures", report.lost(), report.failures.len());
    }
    Ok(())
}

/// What the arguments say, in the words of the launch file.
fn sets(args: &Args, setup: &Setup, out: &std::path::Path) -> Vec<String> {
    let text = |path: &std::path::Path| toml::Value::String(path.display().to_string()).to_string();
    let absolute = |path: &std::path::Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut sets = vec![format!("rig.file={}", text(&absolute(&setup.rig)))];
    for node in ["camera", "tracker"] {
        sets.push(format!("{node}.rig={}", text(&absolute(&setup.rig))));
        sets.push(format!("{node}.scene={}", text(&absolute(&setup.scene))));
        if !setup.object.as_os_str().is_empty() {
            sets.push(format!("{node}.object={}", text(&absolute(&setup.object))));
        }
        sets.push(format!("{node}.size_mm={:?}", setup.size_mm));
        sets.push(format!("{node}.seed={}", setup.seed));
        sets.push(format!("{node}.seconds={:?}", setup.seconds));
    }
    sets.push(format!("run.pace={}", if args.pace() == Pace::Fast { "fast" } else { "real" }));
    sets.push(format!("export.folder={}", text(out)));
    sets.push(format!("record.file={}", text(&out.join("scan.mcap"))));
    if args.headless {
        sets.push("nodes.view.enabled=false".to_owned());
        sets.extend(UNSEEN.map(str::to_owned));
    }
    sets.extend(args.sets.iter().cloned());
    sets
}
