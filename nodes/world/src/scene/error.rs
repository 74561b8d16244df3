//! Why a scene cannot be shown.

use std::path::{Path, PathBuf};

/// What is wrong with a scene file, and where.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The scene file itself.
    #[error("cannot read the scene {path}: {source}", path = .path.display())]
    Read {
        /// The scene file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Not TOML, an unknown key, a value of the wrong kind.
    #[error("{0}")]
    Parse(String),
    /// Whatever it is, it is in this file.
    #[error("scene {path}: {reason}", path = .path.display())]
    InFile {
        /// The scene file.
        path: PathBuf,
        /// What is wrong in it.
        reason: Box<SceneError>,
    },
    /// Nothing to scan.
    #[error("no [[object]]: there is nothing to scan")]
    Empty,
    /// A number that cannot be.
    #[error("{object}: {key} = {value}: {wanted}")]
    Value {
        /// Which object, or "table", or "scene".
        object: String,
        /// The key.
        key: &'static str,
        /// What it holds.
        value: String,
        /// What it should hold.
        wanted: &'static str,
    },
    /// An object of kind "mesh" without a file, or another kind with one.
    #[error("{object}: kind \"mesh\" needs a file, and no other kind has one")]
    File {
        /// Which object.
        object: String,
    },
    /// No object has the name.
    #[error("subject = {subject:?}: the objects are called {names:?}; \"all\" merges them")]
    Subject {
        /// What the file says.
        subject: String,
        /// What there is.
        names: Vec<String>,
    },
    /// Textures cannot be merged.
    #[error("{object} has a texture, so it cannot be merged with others: name one object as the subject")]
    Merge {
        /// Which object.
        object: String,
    },
    /// The user's mesh cannot be read.
    #[error(transparent)]
    Format(#[from] formats::FormatError),
    /// The user's mesh has no size to scale.
    #[error("{path}: all its vertices lie in one point", path = .path.display())]
    Point {
        /// Its file.
        path: PathBuf,
    },
}

impl SceneError {
    pub(super) fn in_file(self, path: &Path) -> Self {
        match self {
            Self::Read { .. } => self,
            other => Self::InFile { path: path.to_owned(), reason: Box::new(other) },
        }
    }
}
