//! What both simulated nodes are told: which scene, seen with which rig, swept for how long, from which seed.

use crate::{Hand, HandError, Scene, SceneError};
use geometry::{Rig, RigError};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The configuration of a simulated node. Both nodes of a rig must be told the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Setup {
    /// A scene file; empty shows the cow.
    pub scene: PathBuf,
    /// A mesh to show instead of the scene: OBJ, PLY, STL, GLB or glTF. Empty shows the scene.
    pub object: PathBuf,
    /// Largest side of that mesh.
    pub size_mm: f64,
    /// The rig file.
    pub rig: PathBuf,
    /// The seed of everything random.
    pub seed: u64,
    /// How long the hand sweeps.
    pub seconds: f64,
}

impl Default for Setup {
    fn default() -> Self {
        let (scene, object, rig) = Default::default();
        Self { scene, object, size_mm: 150.0, rig, seed: 1, seconds: 60.0 }
    }
}

/// Why there is no world to show.
#[derive(Debug, thiserror::Error)]
pub enum SetupError {
    /// The rig file.
    #[error("cannot read the rig {path}: {reason}")]
    Read {
        /// Which file.
        path: String,
        /// What the system said.
        reason: std::io::Error,
    },
    /// The rig.
    #[error("the rig {path}: {reason}")]
    Rig {
        /// Which file.
        path: String,
        /// What is wrong with it.
        reason: RigError,
    },
    /// The scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The hand.
    #[error(transparent)]
    Hand(#[from] HandError),
}

/// A world that is known exactly.
#[derive(Debug, Clone)]
pub struct Known {
    /// What is there.
    pub scene: Scene,
    /// What it is seen with.
    pub rig: Rig,
    /// How that is moved.
    pub hand: Hand,
    /// The seed of everything random.
    pub seed: u64,
}

impl Setup {
    /// Reads rig and scene, and plans the sweep.
    pub fn open(&self) -> Result<Known, SetupError> {
        let rig = read_rig(&self.rig)?;
        let none = |path: &Path| path.as_os_str().is_empty();
        let scene = match (none(&self.object), none(&self.scene)) {
            (false, _) => Scene::with_object(&self.object, self.size_mm)?,
            (true, false) => Scene::load(&self.scene)?,
            (true, true) => Scene::cow()?,
        };
        let hand = Hand::new(&scene, &rig, self.seconds, self.seed)?;
        Ok(Known { scene, rig, hand, seed: self.seed })
    }
}

fn read_rig(path: &Path) -> Result<Rig, SetupError> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|reason| SetupError::Read { path: name.clone(), reason })?;
    Rig::parse(&text).map_err(|reason| SetupError::Rig { path: name, reason })
}
