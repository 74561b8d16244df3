//! What can be wrong with a recording.

use formats::FormatError;
use std::fmt;
use std::io;
use std::path::PathBuf;

/// A recording or scan folder that cannot be played, or not all of it.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The file cannot be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The file is no recording.
    #[error("{} is no recording: {what}", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What gives it away.
        what: String,
    },
    /// A chunk cannot be unpacked; the messages behind it follow.
    #[error("{}: the chunk at byte {at} is damaged ({messages} messages lost): {reason}", path.display())]
    Chunk {
        /// The file.
        path: PathBuf,
        /// Where the chunk begins.
        at: u64,
        /// How many messages were in it, as far as the file says.
        messages: u64,
        /// What is wrong.
        reason: String,
    },
    /// A scan folder.
    #[error(transparent)]
    Folder(#[from] FormatError),
}

/// The part of a recording that is missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Damage {
    /// The file.
    pub path: PathBuf,
    /// From which byte on nothing could be read.
    pub at: u64,
    /// How many bytes are there that could not be read.
    pub bytes: u64,
    /// What is wrong.
    pub reason: String,
}

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (path, at, reason) = (self.path.display(), self.at, &self.reason);
        write!(f, "{path}: the recording was not closed or is damaged at byte {at}: {reason}; ")?;
        write!(f, "{} bytes could not be read, all whole chunks before them could", self.bytes)
    }
}
