//! Pictures: PNG and JPEG.

use crate::{FormatError, Reason, write_whole};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ColorType, DynamicImage, ExtendedColorType, ImageEncoder, ImageError, ImageReader, Limits, RgbImage};
use std::io::{Cursor, Write};
use std::path::Path;
use wire::{Bulk, Frame, Header, Light, PixelFormat};

/// Deflate and JPEG give at most about a thousand bytes for one; a larger promise is a lie.
const MOST_FROM_A_BYTE: u64 = 2048;
/// No picture is larger.
const MAX_BYTES: u64 = 1 << 29;

/// Reads a picture as a frame: grey pictures as [`PixelFormat::Grey8`], all others as [`PixelFormat::Rgb8`], deeper ones
/// reduced to 8 bits. A picture tells neither its time nor its light: the header is the default one, with the laser on,
/// exposure unknown (0), gain and gamma 1.
pub fn read_frame(path: &Path) -> Result<Frame, FormatError> {
    let decoded = std::fs::read(path).map_err(Reason::from).and_then(|bytes| Ok(decode(&bytes)?));
    Ok(frame(decoded.map_err(|reason| reason.of(path))?))
}

/// A picture from its bytes. What its header promises is held against what can come out of so many bytes.
pub(crate) fn decode(bytes: &[u8]) -> Result<DynamicImage, ImageError> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = Limits::default();
    limits.max_alloc = Some((bytes.len() as u64).saturating_mul(MOST_FROM_A_BYTE).clamp(1 << 20, MAX_BYTES));
    reader.limits(limits);
    reader.decode()
}

fn frame(picture: DynamicImage) -> Frame {
    let (width, height) = (picture.width(), picture.height());
    let grey = matches!(picture.color(), ColorType::L8 | ColorType::La8 | ColorType::L16 | ColorType::La16);
    let (format, stride, data) = if grey {
        (PixelFormat::Grey8, width, picture.into_luma8().into_raw())
    } else {
        (PixelFormat::Rgb8, 3 * width, picture.into_rgb8().into_raw())
    };
    Frame {
        header: Header::default(),
        width,
        height,
        stride,
        format,
        light: Light { laser: true, lamp: false },
        exposure_nanos: 0,
        gain: 1.0,
        gamma: 1.0,
        data: Bulk(data),
    }
}

/// Writes a picture as PNG.
pub fn write_rgb(path: &Path, picture: &RgbImage) -> Result<(), FormatError> {
    write_whole(path, |out| encode_png(out, picture))
}

/// Writes a frame as PNG: grey or coloured as it is, YUYV turned into red, green, blue.
pub fn write_frame(path: &Path, frame: &Frame) -> Result<(), FormatError> {
    frame.check().map_err(|e| Reason::syntax(e).of(path))?;
    let row_bytes = frame.format.row_bytes(frame.width);
    let rows = frame.data.chunks(frame.stride as usize).take(frame.height as usize).map(|row| &row[..row_bytes]);
    let (bytes, colour): (Vec<u8>, _) = match frame.format {
        PixelFormat::Grey8 => (rows.flatten().copied().collect(), ExtendedColorType::L8),
        PixelFormat::Rgb8 => (rows.flatten().copied().collect(), ExtendedColorType::Rgb8),
        format @ (PixelFormat::Yuyv | PixelFormat::YuyvFull) => {
            let width = frame.width as usize;
            let pixels = rows.flat_map(|row| (0..width).flat_map(move |u| format.rgb(row, u)));
            (pixels.collect(), ExtendedColorType::Rgb8)
        }
    };
    write_whole(path, |out| Ok(encoder(out).write_image(&bytes, frame.width, frame.height, colour)?))
}

/// Camera noise does not compress, so the quick way loses nothing.
fn encoder<W: Write>(out: W) -> PngEncoder<W> {
    PngEncoder::new_with_quality(out, CompressionType::Fast, FilterType::Sub)
}

pub(crate) fn encode_png(out: impl Write, picture: &RgbImage) -> Result<(), Reason> {
    let (width, height) = picture.dimensions();
    Ok(encoder(out).write_image(picture.as_raw(), width, height, ExtendedColorType::Rgb8)?)
}
