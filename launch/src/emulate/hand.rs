//! What an emulated tracker watches: the hand of the simulated world, as that world's own tracker would see it.

use anyhow::Result;
use nalgebra::{UnitQuaternion, Vector3};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use world::{Setup, Simulation, Tracker};

/// The known world: told the same, the simulated camera shows the same.
#[derive(Debug, clap::Args)]
pub struct HandArgs {
    /// The rig file; its [simulation.tracker] says how wrong the tracker is.
    #[arg(long, value_name = "FILE", default_value = "config/rigs/paper.toml")]
    pub rig: PathBuf,
    /// A scene file.
    #[arg(long, value_name = "FILE", default_value = "config/scenes/cow.toml", conflicts_with = "object")]
    pub scene: PathBuf,
    /// A mesh instead of the scene.
    #[arg(long, value_name = "FILE")]
    pub object: Option<PathBuf>,
    /// The largest side of that mesh.
    #[arg(long, value_name = "N", default_value_t = 150.0)]
    pub size_mm: f64,
    /// The seed of everything random.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// How long the hand sweeps; before and behind it rests.
    #[arg(long, value_name = "N", default_value_t = 60.0)]
    pub seconds: f64,
    /// How far apart several sensors sit on the handset, along its x.
    #[arg(long, value_name = "N", default_value_t = 50.0)]
    pub apart_mm: f64,
}

/// When the hand began, on the emulator's clock.
#[derive(Debug, Clone)]
pub struct Beginning(Arc<AtomicI64>);

impl Default for Beginning {
    fn default() -> Self {
        Self(Arc::new(AtomicI64::new(NOT_YET)))
    }
}

const NOT_YET: i64 = i64::MAX;

impl Beginning {
    /// It begins, or begins anew.
    pub fn set(&self, nanos: i64) {
        self.0.store(nanos, Ordering::SeqCst);
    }

    /// How long ago that was at a moment; nothing while it rests before.
    fn since(&self, nanos: i64) -> i64 {
        match self.0.load(Ordering::SeqCst) {
            NOT_YET => 0,
            begun => nanos - begun,
        }
    }
}

/// Where each sensor is at a moment of the emulator's clock, as emulators ask for it.
pub type Sensors = Box<dyn Fn(u8, i64) -> (Vector3<f64>, UnitQuaternion<f64>) + Send>;

impl HandArgs {
    /// The sensors of a handset, the first of which has this number. Stamps are as late as the rig file says that its
    /// tracker's are: so its `[clock] pose_offset_s` holds for the emulated tracker as for the simulated one.
    pub fn sensors(&self, first: u8, beginning: Beginning) -> Result<Sensors> {
        let setup = Setup {
            scene: self.scene.clone(),
            object: self.object.clone().unwrap_or_default(),
            size_mm: self.size_mm,
            rig: self.rig.clone(),
            seed: self.seed,
            seconds: self.seconds,
        };
        let known = setup.open()?;
        let said = Simulation::from_rig(&known.rig)?.tracker;
        let late_s = said.latency_s + said.clock_offset_s;
        let tracker = Tracker::new(&known.rig, known.hand, known.seed)?;
        let apart_m = self.apart_mm * 1e-3;
        Ok(Box::new(move |sensor, nanos| {
            let world_from_body = tracker.at(beginning.since(nanos) as f64 * 1e-9 - late_s);
            let beside = Vector3::x() * (apart_m * f64::from(sensor.saturating_sub(first)));
            (world_from_body.translation.vector + world_from_body.rotation * beside, world_from_body.rotation)
        }))
    }
}
