//! `limn cluster POINTS -o CLOUD`: the paper's ball clustering on a file.

use crate::config;
use crate::units::Unit;
use anyhow::{Result, bail};
use cluster::BallClusterer;
use std::path::PathBuf;
use wire::{Bulk, CloudPoint, Header, Phase, Scan, ScanPoint};

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn cluster points.ply -o cloud.ply
  limn cluster points.xyz --unit mm -o cloud.ply --set ball_radius_m=0.0005 --set least_points=3
Normals in the file tell the side from which a point was seen. What is written is in metres.";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// PLY, XYZ or CSV.
    pub points: PathBuf,
    /// The cloud (PLY).
    #[arg(long, short)]
    pub output: PathBuf,
    /// The unit of POINTS.
    #[arg(long, value_enum, default_value_t)]
    pub unit: Unit,
    /// Overrule a value of the clustering. May come again.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Reads, clusters, writes.
pub fn run(args: &Args) -> Result<()> {
    let mut clusterer = BallClusterer::new(config::of_kind("cluster", &args.sets)?)?;
    let points = formats::cloud::read(&args.points)?;
    let metres = args.unit.metres();
    clusterer.insert(&Scan {
        points: points.iter().map(|point| scanned(point, metres)).collect::<Bulk<ScanPoint>>(),
        ..Scan::none(Header { phase: Phase::Shape, ..Header::default() })
    });
    let cloud = clusterer.whole();
    for refusal in &cloud.refused {
        tracing::warn!("{} x {}", refusal.count, refusal.reason);
    }
    if cloud.points.is_empty() {
        bail!("nothing is left of the {} points in {}", points.len(), args.points.display());
    }
    formats::cloud::write_ply(&args.output, &cloud.points)?;
    tracing::info!("{} points, {} balls in {}", points.len(), cloud.points.len(), args.output.display());
    Ok(())
}

fn scanned(point: &CloudPoint, metres: f32) -> ScanPoint {
    ScanPoint {
        position_m: point.position_m.map(|x| x * metres),
        to_sensor: point.normal,
        sigma_m: point.sigma_m * metres,
        amplitude: 0.0,
    }
}
