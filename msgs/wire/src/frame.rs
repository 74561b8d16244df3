//! A picture, with the time of its exposure (paper, section 3: the colour camera).

use crate::layout::{layout, message};
use crate::{Bulk, Header, YCbCr};

layout! {
    /// How the bytes of a picture are laid out.
    pub enum PixelFormat {
        /// One byte a pixel.
        Grey8,
        /// Three bytes a pixel: red, green, blue.
        Rgb8,
        /// Four bytes for two pixels, Y0 Cb Y1 Cr: [`YCbCr::LIMITED`].
        Yuyv,
        /// The same over all levels: [`YCbCr::FULL`].
        YuyvFull,
    }
}

impl PixelFormat {
    /// Bytes that a row of `width` pixels needs at least.
    pub fn row_bytes(self, width: u32) -> usize {
        let width = width as usize;
        match self {
            Self::Grey8 => width,
            Self::Rgb8 => 3 * width,
            Self::Yuyv | Self::YuyvFull => 2 * width.next_multiple_of(2),
        }
    }

    /// What its bytes stand for, when they are not light itself.
    pub const fn ycbcr(self) -> Option<YCbCr> {
        match self {
            Self::Grey8 | Self::Rgb8 => None,
            Self::Yuyv => Some(YCbCr::LIMITED),
            Self::YuyvFull => Some(YCbCr::FULL),
        }
    }

    /// Red, green and blue of pixel `u` of a row of a checked frame.
    #[inline]
    pub fn rgb(self, row: &[u8], u: usize) -> [u8; 3] {
        match self {
            Self::Grey8 => [row[u]; 3],
            Self::Rgb8 => [row[3 * u], row[3 * u + 1], row[3 * u + 2]],
            Self::Yuyv => YCbCr::LIMITED.rgb8(of_pair(row, u)),
            Self::YuyvFull => YCbCr::FULL.rgb8(of_pair(row, u)),
        }
    }
}

/// Y, Cb and Cr of pixel `u` in a row of YUYV: two pixels share their colour.
#[inline]
fn of_pair(row: &[u8], u: usize) -> [u8; 3] {
    let pair = 4 * (u / 2);
    [row[2 * u], row[pair + 1], row[pair + 3]]
}

layout! {
    /// What lit the exposure.
    #[derive(Copy, Eq)]
    pub struct Light {
        /// The line laser was on.
        pub laser: bool,
        /// The lamp was on.
        pub lamp: bool,
    }
}

layout! {
    /// One picture.
    pub struct Frame {
        /// `stamp_nanos` is the middle of the exposure.
        pub header: Header,
        /// Pixels in a row.
        pub width: u32,
        /// Rows.
        pub height: u32,
        /// Bytes from one row to the next.
        pub stride: u32,
        /// The layout of `data`.
        pub format: PixelFormat,
        /// What lit it.
        pub light: Light,
        /// How long the shutter was open.
        pub exposure_nanos: i64,
        /// Linear gain of the camera, 1 = none.
        pub gain: f32,
        /// Exponent that the camera applied: value = 255 (light)^(1/gamma).
        pub gamma: f32,
        /// The pixels, row by row.
        pub data: Bulk<u8>,
    }
}
message!(Frame @ 2, data);

/// Why the bytes of a frame cannot be what its header says.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// A picture without pixels.
    #[error("a picture of {width}x{height} pixels holds nothing")]
    Empty {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The rows would overlap.
    #[error("a stride of {stride} bytes is shorter than a row of {needed}")]
    Stride {
        /// As the header says.
        stride: u32,
        /// As the width and format need.
        needed: usize,
    },
    /// Too few or too many bytes.
    #[error("{bytes} bytes came where the header promises {needed} ({width}x{height}, {format:?}, stride {stride})")]
    Size {
        /// Bytes that came.
        bytes: usize,
        /// Bytes that the header promises.
        needed: usize,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// Bytes from one row to the next.
        stride: u32,
        /// Layout.
        format: PixelFormat,
    },
}

impl Frame {
    /// What a camera sends of an exposure: on its topic `frame`, and on its topic `colour`. A picture that the lamp alone
    /// has lit is for colour; on `frame` it is only told, without its pixels, so that whoever counts exposures sees it.
    /// The end goes on both.
    pub fn by_topic(self) -> (Self, Option<Self>) {
        if self.header.is_end() {
            (self.clone(), Some(self))
        } else if self.light.lamp && !self.light.laser {
            (Self { data: Bulk::default(), ..self }, Some(self))
        } else {
            (self, None)
        }
    }

    /// Refuses a picture whose size contradicts its header.
    pub fn check(&self) -> Result<(), FrameError> {
        let (width, height, stride, format) = (self.width, self.height, self.stride, self.format);
        if width == 0 || height == 0 {
            return Err(FrameError::Empty { width, height });
        }
        let row = format.row_bytes(width);
        if (stride as usize) < row {
            return Err(FrameError::Stride { stride, needed: row });
        }
        let needed = stride as usize * (height as usize - 1) + row;
        let bytes = self.data.len();
        if bytes < needed || bytes > stride as usize * height as usize {
            return Err(FrameError::Size { bytes, needed, width, height, stride, format });
        }
        Ok(())
    }
}
