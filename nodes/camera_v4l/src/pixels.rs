//! What a driver delivers, made into what travels.

use crate::mjpeg;
use serde::{Deserialize, Serialize};
use std::fmt;
use wire::PixelFormat;

/// The layouts of pixels that are understood, by their names in V4L2.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum DriverFormat {
    /// Y0 U Y1 V.
    Yuyv,
    /// One byte a pixel.
    Grey,
    /// Red, green, blue.
    Rgb3,
    /// Blue, green, red.
    Bgr3,
    /// Each picture a JPEG. Its blocks blur a laser line; take it only where the line to the camera is too slow for the rest.
    Mjpg,
}

impl DriverFormat {
    /// All of them, the best for a laser line first.
    pub const ALL: [Self; 5] = [Self::Grey, Self::Yuyv, Self::Rgb3, Self::Bgr3, Self::Mjpg];

    /// The four letters that V4L2 knows it by.
    pub fn fourcc(self) -> [u8; 4] {
        *match self {
            Self::Yuyv => b"YUYV",
            Self::Grey => b"GREY",
            Self::Rgb3 => b"RGB3",
            Self::Bgr3 => b"BGR3",
            Self::Mjpg => b"MJPG",
        }
    }

    /// The one with these four letters.
    pub fn of_fourcc(fourcc: [u8; 4]) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.fourcc() == fourcc)
    }

    /// Bytes that a row needs at least; none where rows have no length.
    pub fn least_stride(self, width: u32) -> Option<usize> {
        match self {
            Self::Yuyv => Some(PixelFormat::Yuyv.row_bytes(width)),
            Self::Grey => Some(PixelFormat::Grey8.row_bytes(width)),
            Self::Rgb3 | Self::Bgr3 => Some(PixelFormat::Rgb8.row_bytes(width)),
            Self::Mjpg => None,
        }
    }
}

impl fmt::Display for DriverFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&String::from_utf8_lossy(&self.fourcc()))
    }
}

/// Which levels of brightness and colour `YUYV` uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Levels {
    /// Those that the driver says: all where it says so, else the limited range.
    #[default]
    Driver,
    /// 16 to 235, whatever the driver says.
    Limited,
    /// 0 to 255, whatever the driver says: the driver of webcams never does, and some of them send it.
    Full,
}

impl Levels {
    /// Whether they are all, when the driver says `full` of itself.
    pub fn are_full(self, full: bool) -> bool {
        match self {
            Self::Driver => full,
            Self::Limited => false,
            Self::Full => true,
        }
    }
}

/// How a driver lays out its pictures, as it says itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Of its pixels.
    pub format: DriverFormat,
    /// `YUYV` is over all levels, and not over the limited range; without meaning for the others.
    pub full_range: bool,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Bytes from one row to the next; without meaning for `MJPG`.
    pub stride: u32,
}

/// A picture as it travels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Of its pixels.
    pub format: PixelFormat,
    /// Bytes from one row to the next.
    pub stride: u32,
    /// Row by row.
    pub data: Vec<u8>,
}

/// Why bytes are no picture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PixelError {
    /// The driver's own numbers do not fit each other.
    #[error("{width}x{height} {format} with rows of {stride} bytes is no picture")]
    Layout {
        /// Of its pixels.
        format: DriverFormat,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// Bytes from one row to the next.
        stride: u32,
    },
    /// The end of the picture is missing.
    #[error("{bytes} of {needed} bytes came")]
    Short {
        /// That came.
        bytes: usize,
        /// For a whole picture.
        needed: usize,
    },
    /// A JPEG that cannot be read.
    #[error("a JPEG that cannot be read: {0}")]
    Jpeg(String),
}

/// Takes the bytes of a picture. What travels as the driver sends it is not copied; blue and red change places where they
/// lie; a JPEG is decoded into new memory.
///
/// # Errors
/// Bytes that are no picture of this layout.
pub fn unpack(mut bytes: Vec<u8>, layout: &Layout) -> Result<Picture, PixelError> {
    let Layout { format, full_range, width, height, stride } = *layout;
    let bad = PixelError::Layout { format, width, height, stride };
    if width == 0 || height == 0 {
        return Err(bad);
    }
    let Some(row) = format.least_stride(width) else {
        let (format, data) = mjpeg::decode(&bytes, width, height)?;
        let stride = format.row_bytes(width) as u32;
        return Ok(Picture { format, stride, data });
    };
    let stride_bytes = stride as usize;
    if stride_bytes < row {
        return Err(bad);
    }
    let needed = stride_bytes.checked_mul(height as usize - 1).and_then(|rows| rows.checked_add(row)).ok_or(bad)?;
    if bytes.len() < needed {
        return Err(PixelError::Short { bytes: bytes.len(), needed });
    }
    bytes.truncate(stride_bytes * height as usize);
    let format = match format {
        DriverFormat::Grey => PixelFormat::Grey8,
        DriverFormat::Yuyv if full_range => PixelFormat::YuyvFull,
        DriverFormat::Yuyv => PixelFormat::Yuyv,
        DriverFormat::Bgr3 => {
            for line in bytes.chunks_mut(stride_bytes) {
                line.chunks_exact_mut(3).for_each(|pixel| pixel.swap(0, 2));
            }
            PixelFormat::Rgb8
        }
        DriverFormat::Rgb3 | DriverFormat::Mjpg => PixelFormat::Rgb8,
    };
    Ok(Picture { format, stride, data: bytes })
}
