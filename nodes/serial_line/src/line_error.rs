//! What goes wrong with a port, and what to do about it.

use std::path::PathBuf;

/// A port that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LineError {
    /// No such device.
    #[error("there is no {path}: plug the adapter in, or name the port that it got{present}", path = .path.display())]
    NotThere {
        /// As configured.
        path: PathBuf,
        /// The ports that are there, as the end of a sentence.
        present: String,
    },
    /// Not for this user.
    #[error(
        "{path} may not be opened by this user: add the user to the group that owns it (Debian: `sudo usermod -aG dialout $USER`), and log in again",
        path = .path.display()
    )]
    NoPermission {
        /// As configured.
        path: PathBuf,
    },
    /// Somebody else has it.
    #[error("{path} is in use by another program: stop that one (`fuser {path}` names it)", path = .path.display())]
    Busy {
        /// As configured.
        path: PathBuf,
    },
    /// A file, or a port without hardware.
    #[error("{path} is no serial port that works ({reason}): name another one{present}", path = .path.display())]
    NotSerial {
        /// As configured.
        path: PathBuf,
        /// The system's words.
        reason: String,
        /// The ports that are there, as the end of a sentence.
        present: String,
    },
    /// A speed that this adapter has not.
    #[error("{path} cannot run at {baud} baud ({reason}): choose a speed that adapter and device both have", path = .path.display())]
    Baud {
        /// As configured.
        path: PathBuf,
        /// As configured.
        baud: u32,
        /// The system's words.
        reason: String,
    },
    /// It was there, and is gone.
    #[error("{path} went away ({reason}): plug it in again; it is opened when it is back", path = .path.display())]
    Unplugged {
        /// As configured.
        path: PathBuf,
        /// The system's words.
        reason: String,
    },
    /// Nothing can be sent.
    #[error("{path} takes no bytes: the adapter hangs; unplug it and plug it in again", path = .path.display())]
    Stuck {
        /// As configured.
        path: PathBuf,
    },
    /// The node was told to stop.
    #[error("stopped")]
    Stopped,
}
