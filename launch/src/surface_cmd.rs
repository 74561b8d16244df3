//! `limn surface CLOUD -o MESH`: the surface on a file.

use crate::config;
use crate::units::Unit;
use anyhow::{Result, bail};
use geometry::TriangleMesh;
use std::path::{Path, PathBuf};
use std::time::Instant;
use surface::Surfer;
use wire::{Cloud, CloudPoint, Extent, Header, Phase};

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn surface cloud.ply -o mesh.ply
  limn surface points.xyz --unit mm -o mesh.stl --set fill_holes_mm=5
  limn surface cloud.ply -o closed.stl --set close=true
Normals in the file tell the sides; without them the sides are found from the points. What is written is in metres.";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// PLY, XYZ or CSV.
    pub cloud: PathBuf,
    /// The surface: PLY, OBJ, STL or GLB, by its ending.
    #[arg(long, short)]
    pub output: PathBuf,
    /// The unit of CLOUD.
    #[arg(long, value_enum, default_value_t)]
    pub unit: Unit,
    /// Overrule a value of the surface. May come again.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Reads, lays the surface, writes.
pub fn run(args: &Args) -> Result<()> {
    let write = writer(&args.output)?;
    let mut surfer = Surfer::new(config::of_kind("surface", &args.sets)?)?;
    let mut points = formats::cloud::read(&args.cloud)?;
    let metres = args.unit.metres();
    points.iter_mut().for_each(|point| scale(point, metres));
    let (count, started) = (points.len(), Instant::now());
    let header = Header { phase: Phase::End, ..Header::default() };
    surfer.update(&Cloud { header, extent: Extent::Whole, table: None, points: points.into(), refused: Vec::new() });
    let measured = surfer.final_mesh();
    let mesh = TriangleMesh::from(&measured);
    for refusal in surfer.refused() {
        tracing::warn!("{} x {}", refusal.count, refusal.reason);
    }
    if mesh.triangles.is_empty() {
        bail!("no surface: {count} points in {} are too few or too far apart", args.cloud.display());
    }
    write(&args.output, &mesh, &measured.sigma_m)?;
    let (triangles, seconds) = (mesh.triangles.len(), started.elapsed().as_secs_f64());
    tracing::info!("{count} points, {triangles} triangles in {}, {seconds:.2} s", args.output.display());
    Ok(())
}

fn scale(point: &mut CloudPoint, metres: f32) {
    point.position_m = point.position_m.map(|x| x * metres);
    point.sigma_m *= metres;
    point.spread_m *= metres;
}

type Write = fn(&Path, &TriangleMesh, &[f32]) -> Result<(), formats::FormatError>;

/// Told before the work begins, not after it.
fn writer(path: &Path) -> Result<Write> {
    Ok(match path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase().as_str() {
        "ply" => formats::mesh::write_measured_ply,
        "stl" => |path, mesh, _| formats::mesh::write_stl(path, mesh),
        "obj" => |path, mesh, _| formats::mesh::write_obj(path, mesh, None),
        "glb" => |path, mesh, _| formats::mesh::write_glb(path, mesh, None),
        other => bail!("{}: cannot write {other:?}: say ply, stl, obj or glb", path.display()),
    })
}
