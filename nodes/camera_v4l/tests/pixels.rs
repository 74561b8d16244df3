//! Bytes of a driver into pictures.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use camera_v4l::{Config, DriverFormat, Layout, PixelError, unpack};
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder as _};
use proptest::prelude::*;
use wire::PixelFormat;

fn layout(format: DriverFormat, width: u32, height: u32, stride: u32) -> Layout {
    Layout { format, full_range: false, width, height, stride }
}

#[test]
fn rows_keep_their_length_and_what_is_behind_the_last_is_cut_off() {
    // Two rows of three pixels, in rows of 8 bytes, and a page's worth of nothing.
    let mut bytes: Vec<u8> = (0..16).collect();
    bytes.resize(4096, 0);
    let memory = bytes.as_ptr();
    let picture = unpack(bytes, &layout(DriverFormat::Grey, 3, 2, 8)).unwrap();
    assert_eq!((picture.format, picture.stride), (PixelFormat::Grey8, 8));
    assert_eq!(picture.data, (0..16).collect::<Vec<u8>>());
    assert_eq!(picture.data.as_ptr(), memory, "nothing was copied");
    // A driver need not fill the last row up.
    let picture = unpack((0..14).collect(), &layout(DriverFormat::Yuyv, 3, 2, 8));
    assert_eq!(picture, Err(PixelError::Short { bytes: 14, needed: 16 }), "an odd row has half a pair more");
    assert_eq!(unpack((0..14).collect(), &layout(DriverFormat::Yuyv, 2, 2, 10)).unwrap().data.len(), 14);
}

#[test]
fn the_range_of_yuyv_is_the_drivers_unless_the_configuration_knows_better() {
    for (text, said, format) in [
        ("", false, PixelFormat::Yuyv),
        ("", true, PixelFormat::YuyvFull),
        ("levels = \"full\"", false, PixelFormat::YuyvFull),
        ("levels = \"limited\"", true, PixelFormat::Yuyv),
    ] {
        let config: Config = toml::from_str(text).unwrap();
        let layout = Layout { full_range: config.levels.are_full(said), ..layout(DriverFormat::Yuyv, 2, 1, 4) };
        assert_eq!(unpack(vec![0; 4], &layout).unwrap().format, format, "{text:?}, {said}");
        let grey = Layout { format: DriverFormat::Grey, ..layout };
        assert_eq!(unpack(vec![0; 4], &grey).unwrap().format, PixelFormat::Grey8);
    }
}

#[test]
fn blue_and_red_change_places_and_the_ends_of_rows_do_not_matter() {
    let bytes = vec![1, 2, 3, 4, 5, 6, 99, 7, 8, 9, 10, 11, 12, 99];
    let picture = unpack(bytes, &layout(DriverFormat::Bgr3, 2, 2, 7)).unwrap();
    assert_eq!(picture.format, PixelFormat::Rgb8);
    assert_eq!(picture.data[..6], [3, 2, 1, 6, 5, 4]);
    assert_eq!(picture.data[7..13], [9, 8, 7, 12, 11, 10]);
    let picture = unpack(vec![1, 2, 3], &layout(DriverFormat::Rgb3, 1, 1, 3)).unwrap();
    assert_eq!(picture.data, [1, 2, 3]);
}

fn jpeg(colour: ExtendedColorType, pixels: &[u8], width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, 95).write_image(pixels, width, height, colour).unwrap();
    bytes
}

/// What webcams send: the standard's tables are left out.
fn without_huffman_tables(jpeg: &[u8]) -> Vec<u8> {
    let (mut out, mut at) = (jpeg[..2].to_vec(), 2);
    loop {
        let (marker, length) = (jpeg[at + 1], usize::from(u16::from_be_bytes([jpeg[at + 2], jpeg[at + 3]])));
        if marker == 0xDA {
            out.extend_from_slice(&jpeg[at..]);
            return out;
        }
        if marker != 0xC4 {
            out.extend_from_slice(&jpeg[at..at + 2 + length]);
        }
        at += 2 + length;
    }
}

#[test]
fn jpegs_are_decoded_in_colour_and_grey_with_tables_and_without() {
    let (width, height) = (64, 48);
    let pixels: Vec<u8> =
        (0..width * height).flat_map(|k| [(k % width * 4) as u8, (k / width * 5) as u8, 90]).collect();
    let whole = jpeg(ExtendedColorType::Rgb8, &pixels, width, height);
    let bare = without_huffman_tables(&whole);
    assert!(bare.len() < whole.len() - 400);
    // Drivers fill the buffer up.
    let padded = [&bare[..], &[0; 500]].concat();
    for bytes in [whole, bare, padded] {
        let picture = unpack(bytes, &layout(DriverFormat::Mjpg, width, height, 0)).unwrap();
        assert_eq!((picture.format, picture.stride), (PixelFormat::Rgb8, 3 * width));
        let error: f64 = picture.data.iter().zip(&pixels).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
        let rms = (error / pixels.len() as f64).sqrt();
        assert!(rms < 4.0, "{rms}");
    }
    let grey: Vec<u8> = (0..width * height).map(|k| (k % width * 4) as u8).collect();
    let picture =
        unpack(jpeg(ExtendedColorType::L8, &grey, width, height), &layout(DriverFormat::Mjpg, width, height, 0))
            .unwrap();
    assert_eq!(picture.format, PixelFormat::Grey8);
    assert!(picture.data.iter().zip(&grey).all(|(a, b)| a.abs_diff(*b) < 12));
}

#[test]
fn torn_and_foreign_jpegs_are_refused() {
    let pixels = vec![128; 64 * 48 * 3];
    let whole = jpeg(ExtendedColorType::Rgb8, &pixels, 64, 48);
    let wanted = layout(DriverFormat::Mjpg, 64, 48, 0);
    assert!(matches!(unpack(whole.clone(), &layout(DriverFormat::Mjpg, 32, 24, 0)), Err(PixelError::Jpeg(_))));
    let small = jpeg(ExtendedColorType::Rgb8, &vec![128; 16 * 16 * 3], 16, 16);
    assert!(unpack(small, &wanted).unwrap_err().to_string().contains("16x16, not 64x48"));
    for bytes in [Vec::new(), vec![0xFF], b"GIF89a".to_vec(), whole[..40].to_vec()] {
        assert!(matches!(unpack(bytes, &wanted), Err(PixelError::Jpeg(_))));
    }
}

proptest! {
    #[test]
    fn no_bytes_and_no_numbers_of_a_driver_are_too_much(
        mut bytes in proptest::collection::vec(any::<u8>(), 0..600),
        format in proptest::sample::select(DriverFormat::ALL.to_vec()),
        width in prop_oneof![0_u32..40, any::<u32>()],
        height in prop_oneof![0_u32..40, any::<u32>()],
        stride in prop_oneof![0_u32..120, any::<u32>()],
        begins in any::<bool>(),
    ) {
        if begins && bytes.len() > 2 {
            bytes[..2].copy_from_slice(&[0xFF, 0xD8]);
        }
        // A JPEG's memory is asked for by the size that was set, which the configuration limits.
        let most = if format == DriverFormat::Mjpg { 64 } else { u32::MAX };
        if let Ok(picture) = unpack(bytes, &layout(format, width.min(most), height.min(most), stride)) {
            let row = picture.format.row_bytes(width.min(most));
            prop_assert!(picture.data.len() >= picture.stride as usize * (height.min(most) as usize - 1) + row);
        }
    }

    #[test]
    fn a_jpeg_with_flipped_bits_is_a_picture_or_refused(at in 2_usize..900, bit in 0_u8..8) {
        let pixels: Vec<u8> = (0..64 * 48 * 3_u32).map(|k| (k * 7 % 251) as u8).collect();
        let mut bytes = jpeg(ExtendedColorType::Rgb8, &pixels, 64, 48);
        let at = at % bytes.len();
        bytes[at] ^= 1 << bit;
        if let Ok(picture) = unpack(bytes, &layout(DriverFormat::Mjpg, 64, 48, 0)) {
            prop_assert_eq!(picture.data.len(), picture.format.row_bytes(64) * 48);
        }
    }
}
