//! A scan folder as a row of messages.

use crate::{Message, ReplayError};
use formats::scan_folder::ScanFolder;
use std::path::Path;
use wire::{Frame, Header, Phase, Pose, topic};

/// What the streams of a scan folder are called.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Names {
    /// camera/…/frame and camera/…/colour.
    pub camera: String,
    /// tracker/…/pose.
    pub tracker: String,
    /// rig/…/calibration.
    pub rig: String,
}

impl Default for Names {
    fn default() -> Self {
        Self { camera: "head".into(), tracker: "head".into(), rig: "head".into() }
    }
}

/// A scan folder, ready to be played.
#[derive(Debug)]
pub struct FolderScan {
    folder: ScanFolder,
    names: Names,
}

impl FolderScan {
    /// Reads and checks the tables.
    pub fn open(path: &Path, names: Names) -> Result<Self, ReplayError> {
        Ok(Self { folder: ScanFolder::open(path)?, names })
    }

    /// The scan itself.
    pub fn folder(&self) -> &ScanFolder {
        &self.folder
    }

    /// Calibration, then poses and frames (on their two topics) by their stamps on the camera's clock (a pose before a frame of the same
    /// moment), then the end of both streams. A picture that cannot be read is an error in its place; its number is left
    /// out, so that the gap is seen downstream.
    pub fn messages(&self) -> Result<impl Iterator<Item = Result<Message, ReplayError>> + '_, ReplayError> {
        let calibration = self
            .folder
            .rig
            .calibration()
            .map_err(|e| ReplayError::Folder(formats::Reason::from(e).of(Path::new(&self.folder.rig.name))))?;
        let offset_nanos = calibration.pose_offset_nanos;
        let first = Message::encode(&topic::calibration(&self.names.rig).key, &calibration);
        let (mut pose, mut frame) = (0, 0);
        let mut colour = None;
        let body = std::iter::from_fn(move || {
            if let Some(colour) = colour.take() {
                return Some(Ok(colour));
            }
            let next_pose = self.folder.poses.get(pose);
            let next_frame = self.folder.frames.get(frame);
            let pose_time = next_pose.map(|p| p.header.stamp_nanos.saturating_add(offset_nanos));
            match (pose_time, next_frame) {
                (Some(time), Some(entry)) if time > entry.stamp_nanos => {
                    frame += 1;
                    self.frame(frame - 1, &mut colour)
                }
                (None, Some(_)) => {
                    frame += 1;
                    self.frame(frame - 1, &mut colour)
                }
                (Some(_), _) => {
                    pose += 1;
                    next_pose.map(|p| Ok(self.pose(p)))
                }
                (None, None) => None,
            }
        });
        Ok(std::iter::once(Ok(first)).chain(body).chain(self.ends().into_iter().map(Ok)))
    }

    fn frame(&self, index: usize, for_colour: &mut Option<Message>) -> Option<Result<Message, ReplayError>> {
        let frame = self.folder.frame(index)?;
        Some(frame.map_err(ReplayError::from).map(|picture| {
            let (frame, colour) = picture.by_topic();
            *for_colour = colour.map(|colour| Message::encode(&topic::colour(&self.names.camera).key, &colour));
            Message::encode(&topic::frame(&self.names.camera).key, &frame)
        }))
    }

    /// The tables tell no phase of a pose: it is that of the picture that follows it.
    fn pose(&self, pose: &Pose) -> Message {
        let frames = &self.folder.frames;
        let after =
            frames.partition_point(|f| f.stamp_nanos < pose.header.stamp_nanos).min(frames.len().saturating_sub(1));
        let phase = frames.get(after).map_or(Phase::Aim, |f| f.phase);
        let pose = Pose { header: Header { phase, ..pose.header }, ..pose.clone() };
        Message::encode(&topic::pose(&self.names.tracker).key, &pose)
    }

    fn ends(&self) -> Vec<Message> {
        let folder = &self.folder;
        let end = |last: Option<i64>, count: usize| Header {
            phase: Phase::End,
            seq: count as u64,
            stamp_nanos: last.unwrap_or(0),
            ..Header::default()
        };
        let pose_header = end(folder.poses.last().map(|p| p.header.stamp_nanos), folder.poses.len());
        let frame_header = end(folder.frames.last().map(|f| f.stamp_nanos), folder.frames.len());
        let pose = folder.poses.last().map(|p| Pose { header: pose_header, ..p.clone() });
        let pose = pose.map(|p| Message::encode(&topic::pose(&self.names.tracker).key, &p));
        let camera = &self.names.camera;
        let end = |key: &str| Message::encode(key, &empty_frame(frame_header));
        pose.into_iter().chain([end(&topic::frame(camera).key), end(&topic::colour(camera).key)]).collect()
    }
}

/// The last message of a camera carries no picture.
pub(crate) fn empty_frame(header: Header) -> Frame {
    Frame {
        header,
        width: 0,
        height: 0,
        stride: 0,
        format: wire::PixelFormat::Grey8,
        light: wire::Light { laser: false, lamp: false },
        exposure_nanos: 0,
        gain: 1.0,
        gamma: 1.0,
        data: Vec::new().into(),
    }
}

/// The last message of a stripe detector carries no peaks.
#[cfg(feature = "node")]
pub(crate) fn no_stripe(header: Header) -> wire::Stripe {
    wire::Stripe {
        header,
        width: 0,
        height: 0,
        light: wire::Light { laser: false, lamp: false },
        peaks: Vec::new().into(),
        refused: Vec::new(),
    }
}
