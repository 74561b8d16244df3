//! A recording as a scan folder: pictures and tables that other people's programs can read.

use crate::skipped::Skipped;
use anyhow::{Context as _, Result, bail};
use formats::scan_folder::ScanFolderWriter;
use geometry::Rig;
use replay::{Message, Recording};
use std::path::Path;
use wire::{Calibration, Frame, Pose};

/// Writes what a recording holds of the first handset into a new folder. What cannot be read is left out and told, and the
/// tables are written of all the rest.
pub fn unpack(recording: &Path, folder: &Path) -> Result<()> {
    let source = Recording::open(recording)?;
    source.damages().iter().for_each(|damage| tracing::warn!("{damage}"));
    let mut writer = ScanFolderWriter::create(folder, &rig(&source, recording)?)?;
    let (mut frames, mut poses) = (0u64, 0u64);
    let mut skipped = Skipped::default();
    for message in source.messages()? {
        let Some(message) = skipped.unless_bad(message) else { continue };
        if is_of(&message, "camera") {
            // An end, or an exposure whose pixels went on the other topic, is no picture.
            let frame = skipped.read::<Frame>(&message).filter(|frame| !frame.data.is_empty());
            let written = frame.and_then(|frame| skipped.unless_bad(writer.frame(&frame)));
            frames += u64::from(written.is_some());
        } else if is_of(&message, "tracker")
            && let Some(pose) = skipped.read::<Pose>(&message)
        {
            writer.pose(&pose);
            poses += 1;
        }
    }
    skipped.tell();
    writer.save()?;
    tracing::info!("{frames} pictures and {poses} poses in {}", folder.display());
    Ok(())
}

fn is_of(message: &Message, kind: &str) -> bool {
    message.key.strip_prefix(kind).is_some_and(|rest| rest.starts_with('/'))
}

/// The first calibration that can be read.
fn rig(source: &Recording, path: &Path) -> Result<Rig> {
    let mut skipped = Skipped::default();
    for message in source.messages()?.flatten().filter(|message| is_of(message, "rig")) {
        if let Some(calibration) = skipped.read::<Calibration>(&message) {
            return Rig::from_calibration(&calibration).with_context(|| format!("the rig in {}", path.display()));
        }
    }
    skipped.tell();
    bail!("{} holds no calibration: a scan folder needs its rig", path.display())
}
