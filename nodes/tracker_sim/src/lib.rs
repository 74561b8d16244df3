//! Poses from a simulated tracker, in the order of their stamps.
//!
//! In: a scene, a rig, the seconds and the seed of a sweep; nothing else, so this node and the simulated camera, which
//! never talk to each other, show the same hand in the same world. Out: [`wire::Pose`], world_from_body with the tracker's
//! errors (`world::Tracker` says which) and stamps on the tracker's own clock, in nanoseconds from the start of the sweep.
//! Readings go on for a moment behind the sweep, so that its last frames have poses on both sides; the phase `End` comes
//! from the node, behind them.
//!
//! A tracker may have several receivers on one handset: [`TrackerSim::receiver`] is one of them, where it sits (`receiver` in
//! [`Config`]). Each bends with the room at its own place; its noise comes from the seed and the name of its instance.
//!
//! Readings that the tracker loses are left out, and not counted in `seq`: to who listens they were never sent.
//!
//! ```
//! use tracker_sim::TrackerSim;
//! use world::Scene;
//! let scene = Scene::parse("[[object]]\nkind = \"sphere\"", "".as_ref())?;
//! let rig = geometry::Rig::parse(r#"
//!     camera = { width = 768, height = 576, fx = 1200, fy = 1200, cx = 384, cy = 288 }
//!     laser = { normal = [-0.894, 0, 0.447], distance_m = 0.0894, channel_weights = [1, 0, 0], peaks_per = "row" }
//!     body_from_camera = { translation_m = [0.05, 0, 0], rotation_wxyz = [1, 0, 0, 0] }
//! "#)?;
//! let mut tracker = TrackerSim::new(&scene, &rig, 2.0, 7)?;
//! let first = tracker.next().ok_or("no reading")?;
//! assert_eq!((first.header.seq, first.header.phase), (0, wire::Phase::Aim));
//! let last = tracker.last().ok_or("no more readings")?;
//! assert!(last.header.stamp_nanos > 2_000_000_000 && !last.header.is_end());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod config;
#[cfg(feature = "node")]
pub mod node;

pub use config::{Config, ReceiverError};

use geometry::{Rig, TransformSection};
use wire::Pose;
use world::{Hand, HandError, Scene, SimulationError, Tracker};

/// Why there is nothing to track.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrackerSimError {
    /// The sweep.
    #[error(transparent)]
    Hand(#[from] HandError),
    /// The tracker's numbers.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// Its place on the handset.
    #[error(transparent)]
    Receiver(#[from] ReceiverError),
}

/// The readings of one sweep.
#[derive(Debug, Clone)]
pub struct TrackerSim {
    tracker: Tracker,
    index: u64,
    seq: u64,
}

impl TrackerSim {
    /// The tracker of a rig, watching a sweep of so many seconds over a scene.
    pub fn new(scene: &Scene, rig: &Rig, seconds: f64, seed: u64) -> Result<Self, TrackerSimError> {
        let hand = Hand::new(scene, rig, seconds, seed)?;
        Ok(Self { tracker: Tracker::new(rig, hand, seed)?, index: 0, seq: 0 })
    }

    /// One of several receivers of that tracker, at a place on the handset (body_from_receiver). The hand and the room are
    /// those of the others; noise, stamps and drop-outs are its own, by its name.
    pub fn receiver(
        scene: &Scene,
        rig: &Rig,
        seconds: f64,
        seed: u64,
        place: &TransformSection,
        name: &str,
    ) -> Result<Self, TrackerSimError> {
        let rig = config::seen_from(rig, place)?;
        let Self { tracker, index, seq } = Self::new(scene, &rig, seconds, seed)?;
        Ok(Self { tracker: tracker.of_receiver(name), index, seq })
    }
}

impl Iterator for TrackerSim {
    type Item = Pose;

    /// The next reading that was not lost.
    fn next(&mut self) -> Option<Pose> {
        while self.index < self.tracker.count() {
            let reading = self.tracker.sample(self.index);
            self.index += 1;
            if let Some(mut pose) = reading {
                pose.header.seq = self.seq;
                self.seq += 1;
                return Some(pose);
            }
        }
        None
    }
}
