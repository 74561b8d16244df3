//! `limn model`: a recording or a scan folder, through the whole pipeline, to a model.

use crate::demo::{UNSEEN, table};
use crate::nodes;
use crate::plan::Plan;
use crate::recorded::Recorded;
use crate::run::{self, Course, Harvest, Passed, before, evidence};
use anyhow::{Context as _, Result, bail};
use clap::Args as ClapArgs;
use formats::mesh::LoadedMesh;
use geometry::TriangleMesh;
use report::{Exhibits, Machine, Report, Run};
use std::path::{Path, PathBuf};
use std::time::Instant;
use wire::Mesh;

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn model out/demo/scan.mcap -o out/again
  limn model my-scan/ -o out/mine --set cluster.ball_radius_m=0.0005
INPUT is a recording (MCAP), or a scan folder: rig.toml, frames.csv, poses.csv and the pictures.";

/// The arguments.
#[derive(Debug, ClapArgs)]
pub struct Args {
    /// A recording or a scan folder.
    pub input: PathBuf,
    /// Where the model is written.
    #[arg(short, long, value_name = "DIR")]
    pub out: PathBuf,
    /// Overrule one value: NODE.KEY=VALUE. May come again.
    #[arg(long = "set", value_name = "NODE.KEY=VALUE")]
    pub sets: Vec<String>,
}

pub(crate) const FILES: [(&str, &str); 2] = [
    ("launch/replay.toml", include_str!("../replay.toml")),
    ("launch/pipeline.toml", include_str!("../pipeline.toml")),
];

/// Makes the model. Fails when a stage failed or anything was lost; what was made is written all the same.
pub fn run(args: &Args) -> Result<()> {
    let started = Instant::now();
    let recorded = Recorded::look(&args.input)?;
    std::fs::create_dir_all(&args.out).with_context(|| format!("making the folder {}", args.out.display()))?;
    let out = args.out.canonicalize()?;
    let launch = crate::demo::files::write(&out, &FILES)?;
    let plan = Plan::load(&launch, &sets(args, &recorded, &launch, &out)?, nodes::KINDS)?;
    std::fs::write(out.join("config.toml"), plan.to_toml()).context("writing the effective configuration")?;
    let Passed { harvest, outcome, .. } = run::run(plan.clone(), &Course { out: &out, sweep_s: None, linger: false })?;
    let report = tell(args, &plan, &harvest, outcome.as_ref().err(), started, &out)?;
    table::print(&report, &out)?;
    outcome?;
    if !report.is_good() {
        bail!("{} messages lost; {} failures", report.lost(), report.failures.len());
    }
    Ok(())
}

fn sets(args: &Args, recorded: &Recorded, launch: &Path, out: &Path) -> Result<Vec<String>> {
    let folder = toml::Value::String(out.display().to_string());
    let mut sets = recorded.sets(&args.input.canonicalize()?, launch)?;
    sets.extend([format!("export.folder={folder}"), "run.pace=fast".to_owned()]);
    sets.extend(UNSEEN.map(str::to_owned));
    sets.extend(args.sets.iter().cloned());
    Ok(sets)
}

fn tell(
    args: &Args,
    plan: &Plan,
    harvest: &Harvest,
    failure: Option<&anyhow::Error>,
    started: Instant,
    out: &Path,
) -> Result<Report> {
    let run = Run {
        object: args.input.display().to_string(),
        pace: "fast".to_owned(),
        command: std::env::args().collect::<Vec<_>>().join(" "),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        ..Run::default()
    };
    let shown = Shown::new(plan, harvest);
    let report = Report {
        title: format!("Limn: {}", args.input.display()),
        run,
        machine: Machine::here(),
        counts: harvest.counts(),
        stages: harvest.stages(),
        times: harvest.times(started),
        closed: harvest.closed.as_ref().and_then(report::closed),
        refinement: harvest.refinement.as_ref().map(evidence::refined),
        failures: failure.map(|error| format!("{error:#}")).into_iter().collect(),
        ..Report::default()
    };
    report.write_json(&out.join("report.json"))?;
    report.write_html(&out.join("report.html"), &shown.exhibits())?;
    Ok(report)
}

/// What the page shows of a scan whose truth nobody knows. What is no surface is not shown.
struct Shown {
    model: Option<LoadedMesh>,
    /// So many of its triangles were measured.
    measured: usize,
    /// The surface before refinement, where there was one.
    before: Option<LoadedMesh>,
    surface: TriangleMesh,
    sigma_m: Vec<f32>,
    residuals_m: Vec<f32>,
}

impl Shown {
    fn new(plan: &Plan, harvest: &Harvest) -> Self {
        let plain = |mesh: &Mesh| LoadedMesh { mesh: TriangleMesh::from(mesh), texture: None };
        let is_surface = |loaded: &LoadedMesh| loaded.mesh.check().is_ok();
        let refined = harvest.refinement.as_ref();
        let before = refined.and_then(|_| before::surface(plan, &harvest.placed).ok());
        Self {
            model: harvest.model.as_ref().map(report::painted).filter(is_surface),
            measured: harvest.model.as_ref().map_or(0, |model| model.mesh.measured as usize),
            before: before.as_ref().map(plain).filter(is_surface),
            surface: harvest.mesh.as_ref().map(TriangleMesh::from).unwrap_or_default(),
            sigma_m: harvest.mesh.as_ref().map(|mesh| mesh.sigma_m.to_vec()).unwrap_or_default(),
            residuals_m: harvest.residuals_m(),
        }
    }

    fn exhibits(&self) -> Exhibits<'_> {
        let map = |values: &'_ [f32]| !values.is_empty() && self.surface.check().is_ok();
        Exhibits {
            model: self.model.as_ref(),
            measured: Some(self.measured),
            before: self.before.as_ref(),
            stated: map(&self.sigma_m).then_some((&self.surface, &self.sigma_m)),
            residual: map(&self.residuals_m).then_some((&self.surface, &self.residuals_m)),
            truth: None,
        }
    }
}
