//! Files appear whole or not at all.

use crate::{FormatError, Reason};
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

/// Writes a file under another name beside it and renames it when all is there, so that no reader and no crash ever meets
/// a half one. What stood at `path` stays until then.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), Reason>,
) -> Result<(), FormatError> {
    let part = part_name(path);
    let written = File::create(&part).map_err(Reason::from).and_then(|file| {
        let mut out = BufWriter::new(file);
        write(&mut out)?;
        out.flush()?;
        drop(out);
        Ok(fs::rename(&part, path)?)
    });
    written.map_err(|reason| {
        // The first error is the one to tell.
        let _ = fs::remove_file(&part);
        reason.of(path)
    })
}

fn part_name(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.part", std::process::id()))
}
