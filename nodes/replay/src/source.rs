//! A recording or a scan folder, whichever a path is.

use crate::{Damage, FolderScan, Message, Names, Recording, ReplayError};
use std::path::Path;

/// What can be played.
#[derive(Debug)]
pub enum Source {
    /// An MCAP file.
    Recording(Recording),
    /// A scan folder.
    Folder(Box<FolderScan>),
}

impl Source {
    /// Opens a folder as a scan folder, anything else as a recording.
    pub fn open(path: &Path) -> Result<Self, ReplayError> {
        if path.is_dir() {
            Ok(Self::Folder(Box::new(FolderScan::open(path, Names::default())?)))
        } else {
            Ok(Self::Recording(Recording::open(path)?))
        }
    }

    /// What is missing of files that were cut short or damaged.
    pub fn damages(&self) -> &[Damage] {
        match self {
            Self::Recording(recording) => recording.damages(),
            Self::Folder(_) => &[],
        }
    }

    /// All messages, in their order.
    pub fn messages(&self) -> Result<Box<dyn Iterator<Item = Result<Message, ReplayError>> + '_>, ReplayError> {
        Ok(match self {
            Self::Recording(recording) => Box::new(recording.messages()?),
            Self::Folder(folder) => Box::new(folder.messages()?),
        })
    }
}
