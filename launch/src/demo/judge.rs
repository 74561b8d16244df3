//! Holds what came out against what is known to be true.

use super::{Args, Pace};
use crate::run::Harvest;
use anyhow::{Context as _, Result};
use formats::mesh::LoadedMesh;
use geometry::{Camera, MeshIndex, TimedPose, TriangleMesh};
use report::{Exhibits, Gate, Machine, Report, Run, Time};
use std::path::Path;
use std::time::Instant;
use world::{Known, Surface};

/// Compares, and writes truth.ply, report.json and report.html.
pub fn judge(
    args: &Args,
    known: &Known,
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
    let model = harvest.model.as_ref().map(report::painted);
    match compare(known, harvest, &truth) {
        Ok(comparison) => report.comparison = Some(comparison),
        Err(error) => report.failures.push(format!("{error:#}")),
    }
    if let Some(model) = &harvest.model {
        match report::colour_error(model, &truth) {
            Ok(error) => report.colour = Some(error),
            Err(reason) => report.failures.push(reason.to_string()),
        }
    }
    report.times = harvest.times(started);
    let comparison = Time { what: "comparison".to_owned(), seconds: compared.elapsed().as_secs_f64() };
    report.times.insert(report.times.len().saturating_sub(1), comparison);
    report.write_json(&out.join("report.json"))?;
    let exhibits = Exhibits { model: model.as_ref().filter(|model| model.mesh.check().is_ok()), truth: Some(&truth) };
    report.write_html(&out.join("report.html"), &exhibits)?;
    Ok(report)
}

fn loaded(surface: &Surface) -> LoadedMesh {
    let texture = surface.texture.as_ref().and_then(|texture| {
        let bytes = texture.rgb.iter().flatten().copied().collect();
        image::RgbImage::from_raw(texture.width as u32, texture.height as u32, bytes)
    });
    LoadedMesh { mesh: surface.mesh.clone(), texture }
}

fn compare(known: &Known, harvest: &Harvest, truth: &LoadedMesh) -> Result<geometry::Comparison> {
    let mesh = harvest.mesh.as_ref().context("there is no surface to compare")?;
    let model = TriangleMesh::from(mesh);
    let seed = known.seed;
    let samples = geometry::truth_samples(&truth.mesh, seed)?;
    let scene = MeshIndex::new(&known.scene.whole_mesh())?;
    let way: Vec<_> = harvest.truth.iter().map(|sample| TimedPose::from(sample).pose).collect();
    let camera: &Camera = &known.rig.camera;
    let seen = report::seen_mask(&samples, &scene, &way, camera, &Gate::default());
    Ok(geometry::compare(&model, &truth.mesh, Some(&seen), seed)?)
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
