//! Writing a scan folder, message by message.

use super::frames::{self, default_light, light_word, phase_word};
use super::{FRAMES, POSES, RIG, poses, seconds};
use crate::{FormatError, Reason, image_file, write_whole};
use geometry::Rig;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use wire::{Frame, Phase, Pose, Quality};

/// The columns of a line that stand in it.
type Line = Vec<(&'static str, String)>;

/// Takes messages in any order. Pictures are written at once; the tables when [`Self::save`] is called, whole each time.
#[derive(Debug)]
pub struct ScanFolderWriter {
    folder: PathBuf,
    frames: BTreeMap<i64, Line>,
    poses: BTreeMap<i64, Line>,
    unusable_poses: u64,
}

impl ScanFolderWriter {
    /// Makes the folder and writes the rig; refuses a folder that holds a scan already.
    pub fn create(folder: &Path, rig: &Rig) -> Result<Self, FormatError> {
        let frames_path = folder.join(FRAMES);
        if frames_path.exists() {
            return Err(Reason::syntax("a scan is there already; choose another folder").of(&frames_path));
        }
        let pictures = folder.join("frames");
        fs::create_dir_all(&pictures).map_err(|e| Reason::from(e).of(&pictures))?;
        let rig_path = folder.join(RIG);
        let text = toml::to_string(rig).map_err(|e| Reason::syntax(e).of(&rig_path))?;
        write_whole(&rig_path, |out| Ok(out.write_all(text.as_bytes())?))?;
        let (frames, poses) = (BTreeMap::new(), BTreeMap::new());
        Ok(Self { folder: folder.to_owned(), frames, poses, unusable_poses: 0 })
    }

    /// Writes a picture, named after its `seq`. The message at the end of a stream is none and is passed over.
    pub fn frame(&mut self, frame: &Frame) -> Result<(), FormatError> {
        let header = frame.header;
        let Some(phase) = phase_word(header.phase) else { return Ok(()) };
        let file = format!("frames/{:06}.png", self.frames.len());
        image_file::write_frame(&self.folder.join(&file), frame)?;
        let mut line = vec![("stamp_s", seconds::text(header.stamp_nanos)), ("phase", phase.into()), ("file", file)];
        if frame.light != default_light(header.phase) {
            line.push(("light", light_word(frame.light).into()));
        }
        if frame.exposure_nanos != 0 {
            line.push(("exposure_s", seconds::text(frame.exposure_nanos)));
        }
        line.extend((frame.gain != 1.0).then(|| ("gain", frame.gain.to_string())));
        line.extend((frame.gamma != 1.0).then(|| ("gamma", frame.gamma.to_string())));
        self.frames.insert(header.stamp_nanos, line);
        Ok(())
    }

    /// Takes a reading of the tracker; one that is lost has no place in the table and is counted.
    pub fn pose(&mut self, pose: &Pose) {
        let header = pose.header;
        if header.phase == Phase::End {
            return;
        }
        if pose.quality == Quality::Lost {
            self.unusable_poses += 1;
            return;
        }
        // The table has one sigma for all axes: the largest promises nothing that is not so.
        let largest = |sigma: [f64; 3]| sigma.into_iter().fold(0.0, f64::max);
        let mut line = vec![("stamp_s", seconds::text(header.stamp_nanos))];
        let numbers = pose.world_from_body.translation_m.into_iter().chain(pose.world_from_body.rotation_wxyz);
        line.extend(poses::REQUIRED[1..].iter().copied().zip(numbers.map(|n| n.to_string())));
        line.push(("position_sigma_m", largest(pose.position_sigma_m).to_string()));
        line.push(("rotation_sigma_rad", largest(pose.rotation_sigma_rad).to_string()));
        line.extend((pose.rotation_lag_nanos != 0).then(|| ("rotation_lag_s", seconds::text(pose.rotation_lag_nanos))));
        self.poses.insert(header.stamp_nanos, line);
    }

    /// Readings of the tracker that were lost and left out.
    pub fn unusable_poses(&self) -> u64 {
        self.unusable_poses
    }

    /// Writes the tables of all that has come, in the order of the stamps; may be called again when more has.
    pub fn save(&self) -> Result<(), FormatError> {
        save(&self.folder.join(FRAMES), &self.frames, &frames::REQUIRED, &frames::OPTIONAL)?;
        save(&self.folder.join(POSES), &self.poses, &poses::REQUIRED, &poses::OPTIONAL)
    }
}

/// Columns that no line needs are left out, so that plain scans have plain tables.
fn save(
    path: &Path,
    lines: &BTreeMap<i64, Line>,
    required: &[&'static str],
    optional: &[&'static str],
) -> Result<(), FormatError> {
    let used = |column: &&&'static str| lines.values().flatten().any(|(name, _)| name == *column);
    let columns: Vec<&str> = required.iter().chain(optional.iter().filter(used)).copied().collect();
    write_whole(path, |out| {
        let mut table = csv::Writer::from_writer(out);
        table.write_record(&columns).map_err(Reason::syntax)?;
        for line in lines.values() {
            let cell =
                |column: &&str| line.iter().find(|(name, _)| name == column).map_or("", |(_, text)| text.as_str());
            table.write_record(columns.iter().map(cell)).map_err(Reason::syntax)?;
        }
        Ok(table.flush()?)
    })
}
