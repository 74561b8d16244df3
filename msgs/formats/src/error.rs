//! What was wrong, and with which file.

use geometry::{MeshError, RigError};
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// A file that could not be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct FormatError {
    /// The file.
    pub path: PathBuf,
    /// Why not.
    #[source]
    pub reason: Reason,
}

/// Why a file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum Reason {
    /// The system refused: missing, no permission, disk full.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The name does not tell a format that is understood.
    #[error("{found:?} is not understood; known are {known}")]
    Extension {
        /// What stands behind the last dot.
        found: String,
        /// What could stand there.
        known: &'static str,
    },
    /// The file stops too early.
    #[error("truncated inside {inside}")]
    Truncated {
        /// The part that is incomplete.
        inside: String,
    },
    /// Not what the format asks for.
    #[error("{0}")]
    Syntax(String),
    /// Not what the format asks for, in one line of a text file.
    #[error("line {line}: {what}")]
    Line {
        /// From 1.
        line: usize,
        /// What is wrong with it.
        what: String,
    },
    /// One field of a table.
    #[error("line {line}, column {column}: {what}")]
    Cell {
        /// From 1; the header is line 1.
        line: usize,
        /// The name of the column.
        column: &'static str,
        /// What is wrong with it.
        what: String,
    },
    /// A mesh that cannot be used.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A picture or material file that the file names and that cannot be used.
    #[error("names {named:?}; looked for {}: {why}", looked_for.display())]
    Companion {
        /// As the file spells it.
        named: String,
        /// Where that should be.
        looked_for: PathBuf,
        /// What came of it.
        why: String,
    },
    /// A picture.
    #[error("{0}")]
    Picture(#[from] image::ImageError),
    /// A rig file.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// There is nothing to write.
    #[error("not written, because {0}")]
    Empty(&'static str),
}

impl Reason {
    /// This reason, said of a file.
    pub fn of(self, path: &Path) -> FormatError {
        FormatError { path: path.to_owned(), reason: self }
    }

    pub(crate) fn syntax(what: impl Display) -> Self {
        Self::Syntax(what.to_string())
    }

    pub(crate) fn truncated(inside: impl Display) -> Self {
        Self::Truncated { inside: inside.to_string() }
    }
}
