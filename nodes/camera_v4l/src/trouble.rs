//! What goes wrong with a camera, and what to do about it.

use rustix::io::Errno;
use std::path::{Path, PathBuf};

/// A camera that gives no pictures.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Trouble {
    /// No such device.
    #[error("there is no {device}: plug the camera in, or name the one that is there (`limn devices`)", device = .device.display())]
    NotThere {
        /// As configured.
        device: PathBuf,
    },
    /// Not for this user.
    #[error("{device} may not be opened by this user: {advice}", device = .device.display())]
    NoPermission {
        /// As configured.
        device: PathBuf,
        /// What to do.
        advice: String,
    },
    /// Something else bears the name.
    #[error("{device} is no camera ({reason}): `limn devices` lists those that are", device = .device.display())]
    NoCamera {
        /// As configured.
        device: PathBuf,
        /// Why not.
        reason: String,
    },
    /// Another program streams.
    #[error("{device} is in use by another program: stop that one (`fuser {device}` names it)", device = .device.display())]
    Busy {
        /// As configured.
        device: PathBuf,
    },
    /// The driver has set something else in silence.
    #[error(
        "{device} cannot do what is asked: {what}; ask for what it can do (`limn devices`){allow}",
        device = .device.display()
    )]
    Differs {
        /// As configured.
        device: PathBuf,
        /// What differs, one after the other.
        what: String,
        /// What `may_differ` could allow, as the end of the sentence.
        allow: String,
    },
    /// It can do nothing that is understood here.
    #[error("{device} gives {fourcc}, which is not understood: set format to GREY, YUYV, RGB3, BGR3 or MJPG", device = .device.display())]
    Format {
        /// As configured.
        device: PathBuf,
        /// Four letters.
        fourcc: String,
    },
    /// It was there, and is gone.
    #[error("{device} was unplugged: plug it in again; it is opened when it is back", device = .device.display())]
    Unplugged {
        /// As configured.
        device: PathBuf,
    },
    /// It streams, but nothing comes.
    #[error(
        "{device} has sent no picture for {seconds} s: it is started again; if that does not help, use another USB port, a shorter cable, or a lower rate",
        device = .device.display()
    )]
    Silent {
        /// As configured.
        device: PathBuf,
        /// For how long.
        seconds: u32,
    },
    /// The stream broke.
    #[error(
        "the stream of {device} broke ({reason}): it is started again; if this comes back, use another USB port or a lower rate",
        device = .device.display()
    )]
    Stream {
        /// As configured.
        device: PathBuf,
        /// The system's words.
        reason: String,
    },
    /// Anything else.
    #[error("{device}: {doing}: {reason}", device = .device.display())]
    Other {
        /// As configured.
        device: PathBuf,
        /// What was being done.
        doing: &'static str,
        /// The system's words.
        reason: String,
    },
}

impl Trouble {
    /// What an error of the system means while a camera is opened and set.
    pub fn opening(device: &Path, doing: &'static str, error: &std::io::Error) -> Self {
        let (path, reason) = (device.to_owned(), error.to_string());
        match error.raw_os_error().map(Errno::from_raw_os_error) {
            Some(Errno::NOENT) => Self::NotThere { device: path },
            Some(Errno::ACCESS | Errno::PERM) => {
                let advice = devices::missing(device).unwrap_or_else(|| "see who owns it (`ls -l`)".to_owned());
                Self::NoPermission { device: path, advice }
            }
            Some(Errno::BUSY) => Self::Busy { device: path },
            Some(Errno::NODEV | Errno::NXIO) => Self::Unplugged { device: path },
            Some(Errno::NOTTY | Errno::ISDIR) => Self::NoCamera { device: path, reason },
            _ => Self::Other { device: path, doing, reason },
        }
    }

    /// What an error of the system means while pictures come.
    pub fn streaming(device: &Path, error: &std::io::Error) -> Self {
        let path = device.to_owned();
        match error.raw_os_error().map(Errno::from_raw_os_error) {
            Some(Errno::NODEV | Errno::NXIO | Errno::NOENT) => Self::Unplugged { device: path },
            _ => Self::Stream { device: path, reason: error.to_string() },
        }
    }
}
