//! JPEGs as cameras send them.

use crate::pixels::PixelError;
use wire::PixelFormat;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

const START: [u8; 2] = [0xFF, 0xD8];
const HUFFMAN_TABLES: u8 = 0xC4;
const START_OF_SCAN: u8 = 0xDA;
/// An empty header of the AVI kind: it means the standard's own Huffman tables, which such files leave out.
const AVI_HEADER: [u8; 10] = [0xFF, 0xE0, 0x00, 0x08, b'A', b'V', b'I', b'1', 0x00, 0x00];

/// Pixels of a JPEG that must have this size: grey ones when it has no colours.
pub(crate) fn decode(bytes: &[u8], width: u32, height: u32) -> Result<(PixelFormat, Vec<u8>), PixelError> {
    if bytes.get(..2) != Some(&START) {
        return Err(PixelError::Jpeg("it does not begin as one".to_owned()));
    }
    if has_huffman_tables(bytes) {
        return decode_whole(bytes, width, height);
    }
    let mut whole = Vec::with_capacity(bytes.len() + AVI_HEADER.len());
    whole.extend_from_slice(&START);
    whole.extend_from_slice(&AVI_HEADER);
    whole.extend_from_slice(&bytes[2..]);
    decode_whole(&whole, width, height)
}

fn decode_whole(bytes: &[u8], width: u32, height: u32) -> Result<(PixelFormat, Vec<u8>), PixelError> {
    let error = |error: &dyn std::fmt::Display| PixelError::Jpeg(error.to_string());
    // Strict: a torn picture is refused, not filled up with grey.
    let options = DecoderOptions::default()
        .set_max_width(width as usize)
        .set_max_height(height as usize)
        .set_strict_mode(true)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|e| error(&e))?;
    let format = match decoder.input_colorspace() {
        Some(ColorSpace::Luma) => PixelFormat::Grey8,
        _ => PixelFormat::Rgb8,
    };
    if format == PixelFormat::Grey8 {
        decoder.set_options(options.jpeg_set_out_colorspace(ColorSpace::Luma));
    }
    let info = decoder.info().ok_or_else(|| error(&"it has no header"))?;
    if (u32::from(info.width), u32::from(info.height)) != (width, height) {
        return Err(error(&format_args!("it is {}x{}, not {width}x{height}", info.width, info.height)));
    }
    let mut data = vec![0; format.row_bytes(width) * height as usize];
    if decoder.output_buffer_size() != Some(data.len()) {
        return Err(error(&"its colours are of an unknown kind"));
    }
    decoder.decode_into(&mut data).map_err(|e| error(&e))?;
    Ok((format, data))
}

/// Walks over the segments in front of the pixels.
fn has_huffman_tables(bytes: &[u8]) -> bool {
    let mut at = START.len();
    while let Some(&[0xFF, marker, high, low]) = bytes.get(at..at + 4) {
        match marker {
            HUFFMAN_TABLES => return true,
            START_OF_SCAN => return false,
            // Filling.
            0xFF => at += 1,
            _ => at += 2 + usize::from(u16::from_be_bytes([high, low])),
        }
    }
    // No pixels follow: the decoder will say what is wrong.
    true
}
