//! Holds what came out against what is known to be true.

use super::standing::{lay_onto, move_by};
use super::{Args, Pace};
use crate::plan::Plan;
use crate::run::{Harvest, before, evidence};
use anyhow::{Context as _, Result};
use formats::mesh::LoadedMesh;
use geometry::{Camera, Comparison, MeshIndex, TimedPose, TriangleMesh};
use nalgebra::{Isometry3, Point3};
use report::{Aligned, Closed, ColourErrorReason, Exhibits, Gate, Machine, Refined, Report, Run, Time};
use std::path::Path;
use std::time::Instant;
use world::{Known, Surface};

/// Compares, and writes truth.ply, before.ply, report.json and report.html.
pub fn judge(
    args: &Args,
    known: &Known,
    plan: &Plan,
    harvest: &Harvest,
    failure: Option<&anyhow::Error>,
    started: Instant,
    out: &Path,
) -> Result<Report> {
    let truth = loaded(known.scene.subject());
    formats::mesh::write_ply(&out.join("truth.ply"), &truth.mesh)?;
    let mut report = Report {
        title: format!("Limn: {}", known.scene.subject().name),
        run: about(args, known),
        machine: Machine::here(),
        counts: harvest.counts(),
        stages: harvest.stages(),
        failures: failure.map(|error| format!("{error:#}")).into_iter().collect(),
        ..Report::default()
    };
    let compared = Instant::now();
    let bench = Bench::new(known, harvest, truth)?;
    // Each has stretches that only one core can work on.
    let (shape, before) = rayon::join(|| bench.shape(harvest), || bench.before(plan, harvest));
    let (onto, laid) = match shape {
        Ok(shape) => {
            report.closed = bench.closed(harvest, &shape);
            (report.comparison, report.aligned) = (Some(shape.standing), Some(shape.aligned));
            (shape.onto, Some(shape.laid))
        }
        Err(error) => {
            report.failures.push(format!("{error:#}"));
            (Isometry3::identity(), None)
        }
    };
    let sigma_m = harvest.mesh.as_ref().map_or(&[][..], |mesh| &mesh.sigma_m);
    if let Some(laid) = &laid {
        report.stated = report::stated_error(laid, sigma_m, &bench.truth.mesh)?;
    }
    let (before, without) = before.unzip();
    report.refinement =
        harvest.refinement.as_ref().map(|refinement| Refined { without, ..evidence::refined(refinement) });
    if let Some(before) = &before {
        formats::mesh::write_ply(&out.join("before.ply"), &before.mesh)?;
    }
    let residuals_m = harvest.residuals_m();
    let model = harvest.model.as_ref().map(|model| bench.colour(model, &onto, &mut report));
    report.times = harvest.times(started);
    let comparison = Time { what: "comparison".to_owned(), seconds: compared.elapsed().as_secs_f64() };
    report.times.insert(report.times.len().saturating_sub(1), comparison);
    report.write_json(&out.join("report.json"))?;
    let exhibits = Exhibits {
        model: model.as_ref().filter(|model| model.mesh.check().is_ok()),
        measured: harvest.model.as_ref().map(|model| model.mesh.measured as usize),
        before: before.as_ref().filter(|before| before.mesh.check().is_ok()),
        stated: laid.as_ref().filter(|_| report.stated.is_some()).map(|mesh| (mesh, sigma_m)),
        residual: laid.as_ref().filter(|_| !residuals_m.is_empty()).map(|mesh| (mesh, &*residuals_m)),
        truth: Some(&bench.truth),
    };
    report.write_html(&out.join("report.html"), &exhibits)?;
    Ok(report)
}

/// The surface beside the truth.
struct Shape {
    /// Where it stands.
    standing: Comparison,
    /// The motion that lays it onto the truth, ...
    onto: Isometry3<f64>,
    aligned: Aligned,
    /// ... and the surface after it.
    laid: TriangleMesh,
}

/// What everything is held against.
struct Bench {
    truth: LoadedMesh,
    /// Of the truth's samples, those that the camera could see.
    seen: Vec<bool>,
    seed: u64,
}

impl Bench {
    fn new(known: &Known, harvest: &Harvest, truth: LoadedMesh) -> Result<Self> {
        let samples = geometry::truth_samples(&truth.mesh, known.seed)?;
        let scene = MeshIndex::new(&known.scene.whole_mesh())?;
        let way: Vec<_> = harvest.truth.iter().map(|sample| TimedPose::from(sample).pose).collect();
        let camera: &Camera = &known.rig.camera;
        let seen = report::seen_mask(&samples, &scene, &way, camera, &Gate::default());
        Ok(Self { truth, seen, seed: known.seed })
    }

    /// The surface where it stands, and laid onto the truth.
    fn shape(&self, harvest: &Harvest) -> Result<Shape> {
        let mesh = harvest.mesh.as_ref().context("there is no surface to compare")?;
        let mut laid = TriangleMesh::from(mesh);
        let standing = geometry::compare(&laid, &self.truth.mesh, Some(&self.seen), self.seed)?;
        let (onto, aligned) = lay_onto(&mut laid, &self.truth.mesh, &self.seen, self.seed)?;
        Ok(Shape { standing, onto, aligned, laid })
    }

    /// What closes the surface, laid onto the truth with it.
    fn closed(&self, harvest: &Harvest, shape: &Shape) -> Option<Closed> {
        let whole = harvest.closed.as_ref()?;
        let mut caps = report::caps(whole);
        move_by(&mut caps, &shape.onto);
        let caps = geometry::distances_to(&caps, &self.truth.mesh, self.seed).ok();
        Some(report::closed(whole)?.against(caps, &shape.aligned.comparison.model_to_truth))
    }

    /// The surface that would have come out without refinement. There may be nothing that could be called a surface, which
    /// is no failure.
    fn before(&self, plan: &Plan, harvest: &Harvest) -> Option<(LoadedMesh, Aligned)> {
        harvest.refinement.as_ref()?;
        let mut mesh = TriangleMesh::from(&before::surface(plan, &harvest.placed).ok()?);
        let (_, aligned) = lay_onto(&mut mesh, &self.truth.mesh, &self.seen, self.seed).ok()?;
        Some((LoadedMesh { mesh, texture: None }, aligned))
    }

    /// The colours of the model, after it was laid onto the truth.
    fn colour(&self, model: &wire::Model, onto: &Isometry3<f64>, report: &mut Report) -> LoadedMesh {
        let mut laid = model.clone();
        laid.mesh.vertices_m.iter_mut().for_each(|p| *p = (onto * Point3::from(*p).cast::<f64>()).cast::<f32>().into());
        match report::colour_error(&laid, &self.truth) {
            Ok(error) => report.colour = Some(error),
            // An STL, say: whatever was painted, there is nothing to hold it against.
            Err(ColourErrorReason::TruthWithoutColours) => {}
            Err(reason) => report.failures.push(reason.to_string()),
        }
        // What cannot be compared was told above.
        report.borders = report::border_error(&laid, &self.truth).ok().flatten();
        let mut shown = report::painted(model);
        move_by(&mut shown.mesh, onto);
        shown
    }
}

fn loaded(surface: &Surface) -> LoadedMesh {
    let texture = surface.texture.as_ref().and_then(|texture| {
        let bytes = texture.rgb.iter().flatten().copied().collect();
        image::RgbImage::from_raw(texture.width as u32, texture.height as u32, bytes)
    });
    LoadedMesh { mesh: surface.mesh.clone(), texture }
}

fn about(args: &Args, known: &Known) -> Run {
    let path = |path: &Option<std::path::PathBuf>| path.as_ref().map(|path| path.display().to_string());
    Run {
        object: path(&args.object).unwrap_or_default(),
        scene: args.scene.clone().unwrap_or_else(|| "cow".to_owned()),
        rig: args.rig.clone(),
        seed: Some(args.seed),
        pace: if args.pace() == Pace::Fast { "fast" } else { "real" }.to_owned(),
        sweep_s: Some(known.hand.duration_s()),
        command: std::env::args().collect::<Vec<_>>().join(" "),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        date: String::new(),
    }
}
