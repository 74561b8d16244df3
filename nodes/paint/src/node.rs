//! The wiring: lamp-lit frames are kept until the surface is final, and then painted onto it; a live surface gets some of
//! them.

use crate::preview::Preview;
use crate::{Config, FrameStore, Painter, Shot};
use geometry::TrajectoryBuffer;
use kit::{GATHERED_HISTORY, Input, Node, STREAM_HISTORY};
use std::time::Instant;
use wire::{Frame, Header, Mesh, Model, Phase, Trajectory, topic};

/// Between two samples of the way, a frame's place is taken from them when they are no further apart.
const GAP_NANOS: i64 = 100_000_000;

/// Pictures that are known to aim so well need not be moved, which takes time.
const WELL_AIMED_M: f64 = 1e-4;
/// From the handset to what it sees, about.
const LEVER_M: f64 = 0.2;

/// What has come of one scan.
struct Scan {
    header: Header,
    store: FrameStore,
    way: TrajectoryBuffer,
    /// Of the way.
    revision: u32,
    mesh: Option<Mesh>,
    /// It came since the last preview.
    mesh_is_new: bool,
    frames_ended: bool,
    way_ended: bool,
}

impl Scan {
    fn new(header: Header, bound_bytes: usize) -> Self {
        let (store, way) = (FrameStore::new(bound_bytes), TrajectoryBuffer::default());
        Self { header, store, way, revision: 0, mesh: None, mesh_is_new: false, frames_ended: false, way_ended: false }
    }
}

struct Inputs {
    frames: Input<Frame>,
    way: Input<Trajectory>,
    meshes: Input<Mesh>,
}

/// Paints the surface of every scan until it is told to stop.
pub fn run(mut node: Node) -> anyhow::Result<()> {
    let config: Config = node.spec().config()?;
    config.check()?;
    let bound_bytes = config.memory_mib << 20;
    let [camera, world] = ["camera", "world"].map(|input| node.spec().source_of(input).to_owned());
    let mut inputs = Inputs {
        frames: node.stream(&topic::colour(&camera), GATHERED_HISTORY)?,
        way: node.stream(&topic::trajectory(&world), STREAM_HISTORY)?,
        meshes: node.input(&topic::mesh(), 4)?,
    };
    let mut models = node.output(&topic::textured())?;
    let rig = node.spec().source_of("rig").to_owned();
    let calibration = node.calibration(&rig)?;
    let mut preview = Preview::new(&config, &calibration)?;
    let mut painter = Painter::new(config, &calibration)?;
    node.ready()?;
    let mut scan = Scan::new(Header::default(), bound_bytes);
    while node.wait() {
        take(&mut node, &mut inputs, &mut painter, &mut scan, bound_bytes)?;
        let is_final = scan.mesh.as_ref().is_some_and(|mesh| mesh.header.is_end());
        if is_final && scan.frames_ended && scan.way_ended {
            let model = paint(&mut node, &mut painter, &scan)?;
            let header = Header { phase: Phase::End, ..scan.header };
            models.send(Model { header, ..model })?;
            node.finished(&header)?;
            scan = Scan::new(Header { scan: scan.header.scan, ..Header::default() }, bound_bytes);
        } else if !is_final && scan.mesh_is_new && preview.is_due() {
            scan.mesh_is_new = false;
            let live = scan.mesh.as_ref().and_then(|mesh| preview.paint(mesh, &scan.store, &scan.way, GAP_NANOS));
            live.map(|model| models.send(model)).transpose()?;
        }
    }
    node.close()
}

/// Takes what has come; a new scan starts afresh.
fn take(
    node: &mut Node,
    inputs: &mut Inputs,
    painter: &mut Painter,
    scan: &mut Scan,
    bound_bytes: usize,
) -> anyhow::Result<()> {
    while let Some(trajectory) = inputs.way.next() {
        renew(scan, &trajectory.header, bound_bytes);
        // A better way of the same scan.
        if trajectory.header.revision > scan.revision {
            (scan.revision, scan.way, scan.way_ended) =
                (trajectory.header.revision, TrajectoryBuffer::default(), false);
        }
        trajectory.samples.iter().for_each(|sample| {
            scan.way.push(sample.into());
        });
        scan.way_ended |= trajectory.header.is_end();
        // Colour may come seldom, or never: a fast source need not wait for it.
        if !trajectory.header.is_end() {
            node.finished(&trajectory.header)?;
        }
    }
    while let Some(frame) = inputs.frames.next() {
        renew(scan, &frame.header, bound_bytes);
        scan.header = Header { stamp_nanos: frame.header.stamp_nanos, ..scan.header };
        if frame.header.is_end() {
            scan.frames_ended = true;
            continue;
        }
        if frame.header.phase != Phase::Aim {
            match painter.crop(&frame) {
                Ok(picture) => scan.store.push(picture),
                Err(refusal) => node.refuse(&refusal.to_string(), 1),
            }
        }
        node.finished(&frame.header)?;
    }
    while let Some(mesh) = inputs.meshes.next() {
        renew(scan, &mesh.header, bound_bytes);
        (scan.mesh, scan.mesh_is_new) = (Some(mesh), true);
    }
    Ok(())
}

fn renew(scan: &mut Scan, header: &Header, bound_bytes: usize) {
    if header.scan > scan.header.scan {
        *scan = Scan::new(Header { phase: Phase::Aim, ..header.derived() }, bound_bytes);
    }
}

/// Paints every kept picture onto the final surface.
fn paint(node: &mut Node, painter: &mut Painter, scan: &Scan) -> anyhow::Result<Model> {
    let started = Instant::now();
    let Some(mesh) = &scan.mesh else { anyhow::bail!("painting without a surface") };
    if let Err(error) = painter.mesh(mesh) {
        tracing::error!("the surface cannot be painted: {error}");
        node.refuse("surface that cannot be painted", 1);
    }
    let (mut shots, mut aims_m) = (Vec::new(), Vec::new());
    for picture in scan.store.pictures() {
        match scan.way.at(picture.header.stamp_nanos, GAP_NANOS) {
            Ok(place) => {
                shots.push((picture, place.pose));
                aims_m.push(place.position_sigma_m.hypot(place.rotation_sigma_rad * LEVER_M));
            }
            Err(reason) => node.refuse(&format!("picture {reason}"), 1),
        }
    }
    if painter.config.settle && median(&mut aims_m) > WELL_AIMED_M {
        settle(painter, &mut shots);
    }
    for (picture, world_from_camera) in &shots {
        if let Err(refusal) = painter.picture(picture, world_from_camera) {
            node.refuse(&refusal.to_string(), 1);
        }
    }
    let (model, evidence) = painter.model();
    tracing::info!(
        "{} pictures in {:.2?}: {} cells seen, {} filled in, {} grey",
        evidence.pictures,
        started.elapsed(),
        evidence.seen,
        evidence.filled,
        evidence.grey
    );
    Ok(model)
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}

/// Moves the pictures to where they agree.
fn settle(painter: &mut Painter, shots: &mut [Shot<'_>]) {
    let started = Instant::now();
    let (poses, settling) = painter.settle(shots);
    shots.iter_mut().zip(poses).for_each(|(shot, pose)| shot.1 = pose);
    tracing::info!(
        "{} of {} pictures settled in {:.2?}, by {:.2} mm and {:.2} degrees: they disagree by {:.1}/255, not {:.1}",
        settling.corrected,
        settling.pictures,
        started.elapsed(),
        settling.shift_rms_mm,
        settling.turn_rms_degrees,
        settling.apart_after_255,
        settling.apart_before_255
    );
    for refused in &settling.refused {
        tracing::info!("not settled: {} x {}", refused.count, refused.reason);
    }
}
