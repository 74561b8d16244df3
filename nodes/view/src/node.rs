//! The wiring: takes the newest of everything and shows it.

use crate::cloud::ChunkedCloud;
use crate::evidence::Plotted;
use crate::ways::Ways;
use crate::{Config, picture, refined, serve, show};
use kit::{Input, Node};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};
use wire::topic;
use wire::{Cloud, Frame, Health, LogLine, Mesh, Model, Phase, Refinement, Scan, Stripe, Trajectory};

struct Inputs {
    frames: Input<Frame>,
    colours: Input<Frame>,
    stripes: Input<Stripe>,
    trajectories: Input<Trajectory>,
    refined_ways: Input<Trajectory>,
    refinements: Input<Refinement>,
    scans: Input<Scan>,
    clouds: Input<Cloud>,
    meshes: Input<Mesh>,
    models: Input<Model>,
    healths: Input<Health>,
    logs: Input<LogLine>,
}

impl Inputs {
    fn open(node: &mut Node, camera: &str, world: &str) -> anyhow::Result<Self> {
        Ok(Self {
            frames: node.glimpse(&topic::frame(camera))?,
            colours: node.glimpse(&topic::colour(camera))?,
            stripes: node.glimpse(&topic::stripe(camera))?,
            trajectories: node.glimpse(&topic::trajectory(camera))?,
            refined_ways: node.input(&topic::trajectory(world), 4096)?,
            refinements: node.input(&topic::refinement(world), 16)?,
            scans: node.glimpse(&topic::scan(camera))?,
            clouds: node.input(&topic::cloud(), 4096)?,
            meshes: node.glimpse(&topic::mesh())?,
            models: node.glimpse(&topic::textured())?,
            healths: node.input(&topic::health("**"), 256)?,
            logs: node.input(&topic::log("**"), 256)?,
        })
    }
}

/// Admits an event at most so many times a second.
struct Rate {
    every: Duration,
    last: Option<Instant>,
}

impl Rate {
    fn new(per_s: f64) -> Self {
        Self { every: Duration::from_secs_f64(1.0 / per_s), last: None }
    }

    fn admits(&mut self) -> bool {
        let due = self.last.is_none_or(|last| last.elapsed() >= self.every);
        if due {
            self.last = Some(Instant::now());
        }
        due
    }
}

/// Shows everything until it is told to stop.
pub fn run(mut node: Node, config: Config) -> anyhow::Result<()> {
    config.check()?;
    let camera = node.spec().source_of("camera").to_owned();
    let [rig, world] = ["rig", "world"].map(|input| node.spec().source_of(input).to_owned());
    let mut inputs = Inputs::open(&mut node, &camera, &world)?;
    let served = serve::start(&config)?;
    let rec = &served.recording;
    show::world(rec)?;
    refined::styles(rec)?;
    node.ready()?;
    tracing::info!("look: {}", served.url);
    let calibration = node.calibration(&rig)?;
    let shrunk_by = calibration.camera.width.div_ceil(config.picture_width_px.max(1)).max(1);
    show::calibration(rec, &calibration, shrunk_by)?;

    let (mut pictures, mut surfaces) = (Rate::new(config.pictures_per_s), Rate::new(config.surfaces_per_s));
    let (mut cloud, mut trail, mut painted, mut coloured_scan) = (ChunkedCloud::default(), Vec::new(), false, None);
    let (mut ways, mut plotted) = (Ways::default(), Plotted::default());
    let mut reports: BTreeMap<String, (Instant, Health)> = BTreeMap::new();
    while node.wait() {
        if pictures.admits() {
            fast_part(&mut inputs, rec, &config, shrunk_by, &mut trail, &mut ways)?;
        }
        while let Some(way) = inputs.refined_ways.next() {
            ways.refined(&way);
        }
        if let Some(evidence) = inputs.refinements.newest() {
            show::at(rec, &evidence.header);
            refined::refined(rec, &ways, &evidence, &mut plotted)?;
        }
        while let Some(changes) = inputs.clouds.next() {
            painted &= changes.header.phase == Phase::End;
            cloud.take(&changes);
        }
        if !painted && surfaces.admits() {
            show::cloud(rec, &mut cloud)?;
            if let Some(mesh) = inputs.meshes.newest() {
                // Once it has colours, the next ones follow each surface shortly.
                if coloured_scan != Some(mesh.header.scan) {
                    show::bare(rec, &mesh)?;
                }
                show::bounds(rec, &mesh)?;
            }
        }
        if let Some(model) = inputs.models.newest() {
            show::model(rec, &model)?;
            coloured_scan = Some(model.header.scan);
            painted = model.header.is_end();
        }
        while let Some(report) = inputs.healths.next() {
            let before = reports.insert(report.node.clone(), (Instant::now(), report.clone()));
            let seconds = before.as_ref().map_or(0.0, |(at, _)| at.elapsed().as_secs_f64());
            show::health(rec, &report, before.as_ref().map(|(_, health)| health), seconds)?;
        }
        while let Some(line) = inputs.logs.next() {
            show::log(rec, &line)?;
        }
    }
    rec.flush_blocking()?;
    node.close()
}

fn fast_part(
    inputs: &mut Inputs,
    rec: &rerun::RecordingStream,
    config: &Config,
    shrunk_by: u32,
    trail: &mut Vec<[f32; 3]>,
    ways: &mut Ways,
) -> anyhow::Result<()> {
    if let Some(trajectory) = inputs.trajectories.newest() {
        show::at(rec, &trajectory.header);
        show::trajectory(rec, &trajectory, trail)?;
        ways.tracker(&trajectory);
    }
    for picture in [inputs.colours.newest(), inputs.frames.newest()].into_iter().flatten() {
        if let Some(picture) = picture::shrink(&picture, config.picture_width_px) {
            show::picture(rec, &picture)?;
        }
    }
    if let Some(stripe) = inputs.stripes.newest() {
        show::stripe(rec, &stripe, shrunk_by)?;
    }
    if let Some(scan) = inputs.scans.newest() {
        show::scan(rec, &scan)?;
    }
    Ok(())
}
