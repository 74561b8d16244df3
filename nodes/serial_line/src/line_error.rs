//! What goes wrong with a port, and what to do about it.

use serialport::ErrorKind;
use std::io::ErrorKind as IoKind;
use std::path::{Path, PathBuf};

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

impl LineError {
    /// What an error means with which a port was opened.
    pub fn opening(path: &Path, baud: u32, error: &serialport::Error) -> Self {
        let (path, reason) = (path.to_owned(), error.description.clone());
        match error.kind() {
            ErrorKind::Io(IoKind::NotFound) => Self::NotThere { path, present: present() },
            ErrorKind::Io(IoKind::PermissionDenied) => Self::NoPermission { path },
            // Both of the locks (TIOCEXCL and flock) end here.
            ErrorKind::NoDevice => Self::Busy { path },
            ErrorKind::InvalidInput => Self::Baud { path, baud, reason },
            _ => Self::NotSerial { path, reason, present: present() },
        }
    }
}

/// The ports of this machine, as the end of a sentence.
fn present() -> String {
    let names: Vec<String> =
        serialport::available_ports().unwrap_or_default().into_iter().map(|port| port.port_name).collect();
    if names.is_empty() {
        " (no serial port is there)".to_owned()
    } else {
        format!(" (there are: {})", names.join(", "))
    }
}
