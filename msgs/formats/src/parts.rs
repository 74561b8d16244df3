//! A recording in parts: what its recorder had written before it died, and what it wrote when it lived again.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// What a further part notes in its metadata, with its number: a file that only has such a name is none.
pub const RECORDING_PART: &str = "part";

/// The name of a part, counted from 1: `scan.mcap` goes on in `scan.2.mcap`.
///
/// ```
/// use std::path::Path;
/// let scan = Path::new("out/scan.mcap");
/// assert_eq!(formats::recording_part(scan, 1), scan);
/// assert_eq!(formats::recording_part(scan, 2), Path::new("out/scan.2.mcap"));
/// ```
pub fn recording_part(recording: &Path, number: u32) -> PathBuf {
    if number < 2 {
        return recording.to_owned();
    }
    let mut extension = OsString::from(number.to_string());
    if let Some(kind) = recording.extension() {
        extension.push(".");
        extension.push(kind);
    }
    recording.with_extension(extension)
}

/// The parts that are there, in their order; the first whether it is there or not.
pub fn recording_parts(recording: &Path) -> impl Iterator<Item = PathBuf> + '_ {
    (1..).map(|number| recording_part(recording, number)).take_while(move |part| part == recording || part.exists())
}
