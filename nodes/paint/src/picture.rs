//! What is kept of a frame: the working region, as the camera gave it.

use crate::region::Region;
use wire::{Frame, Header, Phase, PixelFormat};

/// The working region of a lamp-lit frame. It can wait for the final mesh and the final trajectory.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// The frame's.
    pub header: Header,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue, row by row.
    pub pixels: Vec<[u8; 3]>,
    /// Light at value 255, relative to that at a gain of 1 and an exposure of 10 ms.
    pub full_scale: f32,
    /// value = 255 (light)^(1/gamma).
    pub gamma: f32,
}

/// Why a frame colours nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, thiserror::Error)]
pub enum FrameRefusal {
    /// Aiming, or the end of the stream.
    #[error("not in a phase that gathers colour")]
    Phase,
    /// The laser would colour the surface.
    #[error("lit by the laser")]
    Laser,
    /// Neither lamp nor colour phase.
    #[error("not lit by the lamp")]
    Unlit,
    /// The data contradicts the header.
    #[error("size contradicts its header")]
    Malformed,
    /// Another camera, or another mode of it.
    #[error("size is not the calibration's")]
    Size,
    /// Gain or gamma cannot be undone.
    #[error("gain or gamma is not a positive number")]
    Response,
    /// The camera's place is not finite.
    #[error("pose is not finite")]
    Pose,
    /// Nothing to paint on.
    #[error("no surface yet")]
    NoSurface,
}

impl FrameRefusal {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Phase,
        Self::Laser,
        Self::Unlit,
        Self::Malformed,
        Self::Size,
        Self::Response,
        Self::Pose,
        Self::NoSurface,
    ];
}

/// Exposure at which the light is counted as it comes; the figure cancels in the finished texture.
const REFERENCE_EXPOSURE_NANOS: f32 = 1e7;

impl Picture {
    /// Takes the working region out of a frame, or says why the frame is of no use. An exposure of 0 or less is unknown
    /// and taken as 10 ms.
    pub fn crop(frame: &Frame, region: &Region) -> Result<Self, FrameRefusal> {
        usable(frame, region)?;
        let exposure = match frame.exposure_nanos {
            nanos if nanos > 0 => nanos as f32 / REFERENCE_EXPOSURE_NANOS,
            _ => 1.0,
        };
        let (width, height) = (region.camera.width, region.camera.height);
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for row in region.top..region.top + height {
            let bytes = &frame.data[row as usize * frame.stride as usize..];
            read_row(bytes, frame.format, region.left as usize, width as usize, &mut pixels);
        }
        let full_scale = (frame.gain * exposure).recip();
        Ok(Self { header: frame.header, width, height, pixels, full_scale, gamma: frame.gamma })
    }

    /// Linear light for each value of a pixel.
    pub(crate) fn light_of_value(&self) -> [f32; 256] {
        std::array::from_fn(|value| (value as f32 / 255.0).powf(self.gamma) * self.full_scale)
    }
}

fn usable(frame: &Frame, region: &Region) -> Result<(), FrameRefusal> {
    let phase = frame.header.phase;
    if matches!(phase, Phase::Aim | Phase::End) {
        return Err(FrameRefusal::Phase);
    }
    if frame.light.laser {
        return Err(FrameRefusal::Laser);
    }
    if !frame.light.lamp && phase != Phase::Colour {
        return Err(FrameRefusal::Unlit);
    }
    frame.check().map_err(|_| FrameRefusal::Malformed)?;
    if [frame.width, frame.height] != region.whole {
        return Err(FrameRefusal::Size);
    }
    let known = |value: f32| (1e-6..1e6).contains(&value);
    if known(frame.gain) && known(frame.gamma) { Ok(()) } else { Err(FrameRefusal::Response) }
}

/// Appends `count` pixels of a row from column `left` on.
fn read_row(bytes: &[u8], format: PixelFormat, left: usize, count: usize, pixels: &mut Vec<[u8; 3]>) {
    match format {
        PixelFormat::Rgb8 => {
            pixels.extend(bytes[3 * left..3 * (left + count)].chunks_exact(3).map(|p| [p[0], p[1], p[2]]));
        }
        PixelFormat::Grey8 | PixelFormat::Yuyv | PixelFormat::YuyvFull => {
            pixels.extend((left..left + count).map(|u| format.rgb(bytes, u)));
        }
    }
}
