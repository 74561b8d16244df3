//! A scan folder: how other people's scans come in, and ours go out.
//!
//! | file | what |
//! |---|---|
//! | rig.toml | the handset, as [`geometry::Rig`] spells it |
//! | frames.csv | `stamp_s,phase,file`, and where they say more than the defaults `light`, `exposure_s`, `gain`, `gamma` |
//! | poses.csv | `stamp_s,x_m,y_m,z_m,qw,qx,qy,qz` = world_from_body, and `position_sigma_m`, `rotation_sigma_rad`, `rotation_lag_s` |
//! | frames/ | the pictures, PNG or JPEG, of the size that rig.toml states |
//!
//! Stamps are seconds, read exactly to the nanosecond, and grow from line to line. `phase` is aim, shape, colour or both;
//! `light` is laser, lamp, both or none. Where `light` is not said it follows from the phase: the laser in aim, shape and
//! both, the lamp in colour. `gamma` is 1 (a linear camera) unless it is said.

mod frames;
mod poses;
mod seconds;
mod writer;

pub use frames::FrameEntry;
pub use poses::{POSITION_SIGMA_M, ROTATION_SIGMA_RAD};
pub use writer::ScanFolderWriter;

use crate::{FormatError, Reason, image_file};
use geometry::Rig;
use std::fs;
use std::path::{Path, PathBuf};
use wire::{Frame, Pose};

const RIG: &str = "rig.toml";
const FRAMES: &str = "frames.csv";
const POSES: &str = "poses.csv";

/// A scan folder whose tables have been read and checked; the pictures are read one by one.
#[derive(Debug, Clone)]
pub struct ScanFolder {
    /// The handset; named after the folder when the file gives no name.
    pub rig: Rig,
    /// The pictures, in the order of their stamps.
    pub frames: Vec<FrameEntry>,
    /// The tracker's readings, in the order of their stamps, counted in `seq`.
    pub poses: Vec<Pose>,
}

impl ScanFolder {
    /// Reads rig and tables. Fails, naming file, line and column, on what is missing, unknown, not finite, out of order or
    /// no unit quaternion, and on pictures that are not there.
    pub fn open(folder: &Path) -> Result<Self, FormatError> {
        let rig = in_file(folder.join(RIG), |path| {
            let mut rig = Rig::parse(&fs::read_to_string(path)?)?;
            if rig.name.is_empty() {
                let folder = fs::canonicalize(folder)?;
                rig.name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
            }
            Ok(rig)
        })?;
        let frames = in_file(folder.join(FRAMES), |path| frames::read(path, folder))?;
        let poses = in_file(folder.join(POSES), poses::read)?;
        Ok(Self { rig, frames, poses })
    }

    /// The picture number `index` of [`Self::frames`]; `None` behind the last. Fails when it cannot be read or has another
    /// size than rig.toml states.
    pub fn frame(&self, index: usize) -> Option<Result<Frame, FormatError>> {
        let entry = self.frames.get(index)?;
        let sized = image_file::read_frame(&entry.path).and_then(|frame| {
            let (width, height) = (self.rig.camera.width, self.rig.camera.height);
            if (frame.width, frame.height) != (width, height) {
                let what = format!("{}x{} pixels, but {RIG} says {width}x{height}", frame.width, frame.height);
                return Err(Reason::Syntax(what).of(&entry.path));
            }
            Ok(Frame {
                header: entry.header(index),
                light: entry.light,
                exposure_nanos: entry.exposure_nanos,
                gain: entry.gain,
                gamma: entry.gamma,
                ..frame
            })
        });
        Some(sized)
    }
}

fn in_file<T>(path: PathBuf, read: impl FnOnce(&Path) -> Result<T, Reason>) -> Result<T, FormatError> {
    read(&path).map_err(|reason| reason.of(&path))
}
