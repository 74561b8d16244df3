//! `limn refine SCAN -o DIR`: the refinement alone on a recording, without a bus, with its evidence.

use crate::live::print;
use crate::model_cmd::FILES;
use crate::nodes;
use crate::plan::Plan;
use crate::recorded::Recorded;
use crate::run::before::{self, config};
use crate::skipped::Skipped;
use anyhow::{Context as _, Result};
use geometry::{METRES_PER_MM, TimedPose, TrajectoryBuffer, TriangleMesh};
use refine::{Evidence, Refinement, Refiner};
use register::Register;
use replay::{Message, Source};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;
use stripe::StripeDetector;
use triangulate::Triangulator;
use wire::{Calibration, Frame, Mesh, Pose, Profile, Scan, Stripe};

/// Examples for `--help`.
pub const HELP: &str = "Examples:
  limn refine out/demo/scan.mcap -o out/refined --compare
  limn refine scan.mcap -o out/looser --set refine.clock_ms=60 --set refine.bias_knot_ms=250
Writes mesh.ply, trajectory.csv (world_from_camera) and evidence.json; with --compare also before.ply, what the tracker
alone would have given. Other nodes' settings are those of the recording.";

/// The arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recording or a scan folder.
    pub input: PathBuf,
    /// Where the results are written.
    #[arg(short, long, value_name = "DIR")]
    pub out: PathBuf,
    /// Also without refinement, and what changed.
    #[arg(long)]
    pub compare: bool,
    /// Overrule one value: NODE.KEY=VALUE. May come again.
    #[arg(long = "set", value_name = "NODE.KEY=VALUE")]
    pub sets: Vec<String>,
}

/// Reads, refines, writes, tells.
pub fn run(args: &Args) -> Result<()> {
    std::fs::create_dir_all(&args.out).with_context(|| format!("making the folder {}", args.out.display()))?;
    let launch = crate::demo::files::write(&args.out, &FILES)?;
    let mut sets = Recorded::look(&args.input)?.sets(&args.input, &launch)?;
    sets.extend(args.sets.iter().cloned());
    let plan = Plan::load(&launch, &sets, nodes::KINDS)?;
    let mut bench = gather(&plan, &args.input)?;
    let started = Instant::now();
    let refinement = bench.refiner.finish()?;
    let took_s = started.elapsed().as_secs_f64();
    let scans: Vec<Scan> = refinement.scans().collect();
    save(&args.out.join("mesh.ply"), &before::surface(&plan, &scans)?)?;
    write(&args.out.join("trajectory.csv"), &way(&refinement.trajectory))?;
    write(&args.out.join("evidence.json"), &(serde_json::to_string_pretty(&refinement.evidence)? + "\n"))?;
    let mut text = told(&refinement.evidence, took_s);
    if args.compare {
        let placed = bench.placed();
        save(&args.out.join("before.ply"), &before::surface(&plan, &placed)?)?;
        text.push_str(&compared(&placed, &refinement));
    }
    let _ = writeln!(text, "\n  {}", args.out.display());
    print(&text)
}

fn save(path: &Path, mesh: &Mesh) -> Result<(), formats::FormatError> {
    formats::mesh::write_measured_ply(path, &TriangleMesh::from(mesh), &mesh.sigma_m)
}

/// The stages up to refinement, as far as a recording needs them.
struct Bench {
    /// Finds the stripes, where the recording does not hold them.
    stripe: Option<StripeDetector>,
    triangulator: Triangulator,
    register: Register,
    refiner: Refiner,
}

/// What cannot be read is left out and told; the rest is refined all the same.
fn gather(plan: &Plan, input: &Path) -> Result<Bench> {
    let source = Source::open(input)?;
    source.damages().iter().for_each(|damage| tracing::warn!("{damage}"));
    let mut bench = None;
    let mut skipped = Skipped::default();
    for message in source.messages()? {
        let Some(message) = skipped.unless_bad(message) else { continue };
        match &mut bench {
            None if message.key.starts_with("rig/") => {
                let calibration = skipped.read::<Calibration>(&message);
                bench = calibration.map(|calibration| Bench::new(plan, &calibration)).transpose()?;
            }
            None => {}
            Some(bench) => bench.take(&message, &mut skipped),
        }
    }
    skipped.tell();
    bench.with_context(|| format!("{} holds no calibration: without its rig nothing can be measured", input.display()))
}

impl Bench {
    fn new(plan: &Plan, calibration: &Calibration) -> Result<Self> {
        let stripe = plan.node("stripe").map(|_| config(plan, "stripe")).transpose()?;
        Ok(Self {
            stripe: stripe.map(|config| StripeDetector::new(config, &calibration.laser)).transpose()?,
            triangulator: Triangulator::new(config(plan, "triangulate")?, calibration)?,
            register: Register::new(config(plan, "register")?, calibration)?,
            refiner: Refiner::new(config(plan, "refine")?, calibration)?,
        })
    }

    fn take(&mut self, message: &Message, skipped: &mut Skipped) {
        let [kind, _, stream] = message.key.split('/').collect::<Vec<_>>()[..] else { return };
        match (kind, stream, &mut self.stripe) {
            ("tracker", "pose", _) => {
                if let Some(pose) = skipped.read(message) {
                    self.pose(&pose);
                }
            }
            ("stripe", "stripe", None) => {
                if let Some(stripe) = skipped.read(message) {
                    self.stripe(&stripe);
                }
            }
            ("camera", "frame", Some(detector)) => {
                let frame = skipped.read::<Frame>(message).filter(|frame| !frame.header.is_end());
                if let Some(stripe) = frame.and_then(|frame| skipped.unless_bad(detector.process(&frame))) {
                    self.stripe(&stripe);
                }
            }
            _ => {}
        }
    }

    fn pose(&mut self, pose: &Pose) {
        if !pose.header.is_end() {
            self.register.pose(pose);
            self.refiner.pose(pose);
        }
    }

    fn stripe(&mut self, stripe: &Stripe) {
        if !stripe.header.is_end() {
            let profile: Profile = self.triangulator.process(stripe);
            self.refiner.profile(&profile);
            self.register.profile(profile);
        }
    }

    /// What the tracker alone makes of it.
    fn placed(&mut self) -> Vec<Scan> {
        self.register.finish();
        self.register.drain().collect()
    }
}

fn told(evidence: &Evidence, took_s: f64) -> String {
    let mut text = String::from("\n");
    let mut row = |what: &str, value: String| {
        let _ = writeln!(text, "  {what:<42} {value}");
    };
    row("refined in", format!("{took_s:.1} s"));
    let residual = &evidence.residual;
    let off = format!("{:.3} mm, {:.3} mm before", residual.after_mm, residual.before_mm);
    row("points off their common surface (median)", off);
    let clock = &evidence.clock;
    let sigma = clock.sigma_ms.map_or(String::new(), |sigma| format!(", sigma {sigma:.2}"));
    row("the rig's pose offset is too large by", format!("{:+.2} ms{sigma}", clock.tau_ms));
    if let Some(sigma) = clock.rotation_lag_sigma_ms {
        row("orientations are older than said by", format!("{:+.2} ms, sigma {sigma:.2}", clock.rotation_lag_ms));
    }
    let hand_eye = &evidence.hand_eye;
    let held = if hand_eye.freed { "" } else { " (held)" };
    row("hand-eye shift, mm", format!("{:.2?}{held}", hand_eye.shift_mm));
    row("hand-eye rotation, degrees", format!("{:.3?}{held}", hand_eye.turn_deg));
    row("frames kept", evidence.frames_kept.to_string());
    row("frames left out", evidence.dropped.len().to_string());
    row("frames that a flat table helped", evidence.frames_on_table.to_string());
    evidence.refused.iter().for_each(|refused| row("refused", format!("{} x {}", refused.count, refused.reason)));
    evidence.notices.iter().for_each(|notice| row("NOTE", refine::sentence(notice)));
    text
}

/// How far frames and points moved from where the tracker has them.
fn compared(placed: &[Scan], refinement: &Refinement) -> String {
    let mut way = TrajectoryBuffer::default();
    refinement.trajectory.iter().for_each(|pose| {
        way.push(*pose);
    });
    let moved = placed.iter().filter_map(|scan| {
        let now = way.at(scan.header.stamp_nanos, i64::MAX).ok()?.pose;
        let then = geometry::rigid_from_wire(&scan.world_from_camera)?;
        let motion = now * then.inverse();
        let middle = scan.points.get(scan.points.len() / 2)?;
        let p = nalgebra::Point3::from(middle.position_m).cast::<f64>();
        let shift = (now.translation.vector - then.translation.vector).norm();
        Some([shift / METRES_PER_MM, motion.rotation.angle().to_degrees(), (motion * p - p).norm() / METRES_PER_MM])
    });
    let moved: Vec<[f64; 3]> = moved.collect();
    let rms = |k: usize| (moved.iter().map(|m| m[k] * m[k]).sum::<f64>() / moved.len().max(1) as f64).sqrt();
    format!(
        "\n  against the smoothed tracker, rms over {} frames: the camera moved {:.2} mm and turned {:.2} degrees, the middle of \
         its stripe moved {:.2} mm\n",
        moved.len(),
        rms(0),
        rms(1),
        rms(2)
    )
}

fn way(poses: &[TimedPose]) -> String {
    let mut text = String::from("stamp_s,x_m,y_m,z_m,qw,qx,qy,qz,position_sigma_m,rotation_sigma_rad\n");
    for TimedPose { stamp_nanos, pose, position_sigma_m, rotation_sigma_rad } in poses {
        let ([x, y, z], q) = (pose.translation.vector.into(), pose.rotation.quaternion());
        let stamp_s = *stamp_nanos as f64 * 1e-9;
        let _ = writeln!(
            text,
            "{stamp_s:.9},{x:.7},{y:.7},{z:.7},{:.9},{:.9},{:.9},{:.9},{position_sigma_m:.3e},{rotation_sigma_rad:.3e}",
            q.w, q.i, q.j, q.k
        );
    }
    text
}

fn write(path: &Path, text: &str) -> Result<()> {
    let written = formats::write_whole(path, |out| Ok(out.write_all(text.as_bytes())?));
    written.with_context(|| format!("writing {}", path.display()))
}
