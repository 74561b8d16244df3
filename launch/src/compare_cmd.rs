//! `limn compare MODEL TRUTH`: both ways, by distances to triangles.

use crate::live::print;
use crate::units::Unit;
use anyhow::{Context as _, Result};
use geometry::{Alignment, Comparison, Completeness, TriangleMesh};
use nalgebra::Isometry3;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn compare out/demo/mesh.ply out/demo/truth.ply
  limn compare mine.stl reference.obj --model-unit mm --truth-unit mm --align --json";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// What was made: OBJ, PLY, STL, GLB or glTF.
    pub model: PathBuf,
    /// What is true.
    pub truth: PathBuf,
    /// Move the model onto the truth first, from where it lies.
    #[arg(long)]
    pub align: bool,
    /// For programs.
    #[arg(long)]
    pub json: bool,
    /// The unit of MODEL.
    #[arg(long, value_enum, default_value_t)]
    pub model_unit: Unit,
    /// The unit of TRUTH.
    #[arg(long, value_enum, default_value_t)]
    pub truth_unit: Unit,
    /// Of the points that are spread over both.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// Prints the comparison.
pub fn run(args: &Args) -> Result<()> {
    let mut model = read(&args.model, args.model_unit)?;
    let truth = read(&args.truth, args.truth_unit)?;
    let mut alignment = None;
    if args.align {
        let found = geometry::align(&model, &truth, &Isometry3::identity(), args.seed)?;
        if !found.converged {
            tracing::warn!("the alignment has not settled: lay the model nearer to the truth first");
        }
        model.vertices.iter_mut().for_each(|p| *p = (found.truth_from_model * p.cast::<f64>()).cast());
        alignment = Some(found);
    }
    let comparison = geometry::compare(&model, &truth, None, args.seed)?;
    print(&if args.json { json(&comparison, alignment.as_ref())? } else { table(&comparison, alignment.as_ref()) })
}

fn read(path: &Path, unit: Unit) -> Result<TriangleMesh> {
    let mut mesh = formats::mesh::read_z_up(path)?.mesh;
    mesh.vertices.iter_mut().for_each(|p| *p *= unit.metres());
    Ok(mesh)
}

fn json(comparison: &Comparison, alignment: Option<&Alignment>) -> Result<String> {
    let mut whole = serde_json::to_value(comparison)?;
    if let Some(Alignment { truth_from_model, rms_mm, kept_share, observed_directions, converged, .. }) = alignment {
        let rotation = truth_from_model.rotation.quaternion();
        whole["alignment"] = serde_json::json!({
            "translation_m": truth_from_model.translation.vector.as_slice(),
            "rotation_wxyz": [rotation.w, rotation.i, rotation.j, rotation.k],
            "rms_mm": rms_mm, "kept_share": kept_share, "observed_directions": observed_directions, "converged": converged,
        });
    }
    Ok(serde_json::to_string_pretty(&whole).context("writing JSON")? + "\n")
}

fn table(comparison: &Comparison, alignment: Option<&Alignment>) -> String {
    let d = &comparison.model_to_truth;
    let mut text = String::new();
    if let Some(Alignment { truth_from_model, rms_mm, kept_share, .. }) = alignment {
        let moved_mm = 1e3 * truth_from_model.translation.vector.norm();
        let turned = truth_from_model.rotation.angle().to_degrees();
        let _ = writeln!(
            text,
            "aligned          moved {moved_mm:.3} mm, turned {turned:.3} degrees; {:.0} % of the points to {rms_mm:.4} mm",
            100.0 * kept_share
        );
    }
    let _ = writeln!(
        text,
        "model to truth   rms {:.4} mm, median {:.4}, 95 % within {:.4}, max {:.4}, bias {:+.4} (outside is +)",
        d.rms_mm, d.median_mm, d.p95_mm, d.max_mm, d.bias_mm
    );
    let _ = writeln!(text, "truth to model   {}", shares(&comparison.truth_to_model));
    text
}

fn shares(completeness: &Completeness) -> String {
    let share = |w: &geometry::Within| format!("{:.2} % within {} mm", 100.0 * w.share, w.distance_mm);
    completeness.within.iter().map(share).collect::<Vec<_>>().join(", ")
}
