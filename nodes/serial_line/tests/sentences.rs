//! Each thing that is wrong with a port is a sentence of its own that says what to do.

#![cfg(feature = "serial")]
#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use serial_line::{HostClock, Line, LineError, LineSettings};
use serialport::{Error, ErrorKind};
use std::io::ErrorKind as Io;
use std::path::{Path, PathBuf};

#[test]
fn each_error_of_the_system_says_what_to_do() {
    let path = Path::new("/dev/ttyUSB7");
    // A test that runs as root is refused nothing, so the system's words are given here.
    for (kind, advice) in [
        (ErrorKind::Io(Io::NotFound), "plug the adapter in"),
        (ErrorKind::Io(Io::PermissionDenied), "usermod -aG dialout"),
        (ErrorKind::NoDevice, "`fuser /dev/ttyUSB7` names it"),
        (ErrorKind::InvalidInput, "cannot run at 31250 baud"),
        (ErrorKind::Unknown, "is no serial port that works (the system's words)"),
    ] {
        let sentence = LineError::opening(path, 31_250, &Error::new(kind, "the system's words")).to_string();
        assert!(sentence.contains(advice) && sentence.contains("/dev/ttyUSB7"), "{kind:?}: {sentence}");
    }
}

#[test]
fn what_the_system_says_of_real_paths_is_understood() {
    let open = |path: &str| {
        let settings = LineSettings { path: PathBuf::from(path), baud: 115_200, rts: false, dtr: true };
        Line::open(&settings, HostClock::start(), Default::default()).err().unwrap()
    };
    assert!(matches!(open("/dev/no_such_port"), LineError::NotThere { .. }));
    assert!(matches!(open("/dev/null"), LineError::NotSerial { .. }));
    assert!(matches!(open("/dev"), LineError::NotSerial { .. }));
}
