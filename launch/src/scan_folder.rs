//! A recording as a scan folder: pictures and tables that other people's programs can read.

use anyhow::{Context as _, Result, bail};
use formats::scan_folder::ScanFolderWriter;
use geometry::Rig;
use replay::Recording;
use std::path::Path;
use wire::{Calibration, Frame, Pose};

/// Writes what a recording holds of the first handset into a new folder.
pub fn unpack(recording: &Path, folder: &Path) -> Result<()> {
    let source = Recording::open(recording)?;
    let mut writer = ScanFolderWriter::create(folder, &rig(&source, recording)?)?;
    let (mut frames, mut poses) = (0u64, 0u64);
    for message in source.messages()? {
        let message = message?;
        let stream = |kind: &str| message.key.strip_prefix(kind).is_some_and(|rest| rest.starts_with('/'));
        if stream("camera") {
            let frame: Frame = message.decode()?;
            // An end, or an exposure whose pixels went on the other topic.
            if !frame.data.is_empty() {
                writer.frame(&frame)?;
                frames += 1;
            }
        } else if stream("tracker") {
            writer.pose(&message.decode::<Pose>()?);
            poses += 1;
        }
    }
    writer.save()?;
    tracing::info!("{frames} pictures and {poses} poses in {}", folder.display());
    Ok(())
}

fn rig(source: &Recording, path: &Path) -> Result<Rig> {
    for message in source.messages()? {
        let message = message?;
        if message.key.starts_with("rig/") {
            let calibration: Calibration = message.decode()?;
            return Rig::from_calibration(&calibration).with_context(|| format!("the rig in {}", path.display()));
        }
    }
    bail!("{} holds no calibration: a scan folder needs its rig", path.display())
}
