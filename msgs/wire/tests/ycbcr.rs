//! Y'CbCr against the published levels of colour bars.

use wire::{PixelFormat, YCbCr};

/// Bars at full brightness: red, green, blue; ITU-R BT.601 in its limited range; the same in a JPEG (JFIF).
const BARS: [([u8; 3], [u8; 3], [u8; 3]); 8] = [
    ([255, 255, 255], [235, 128, 128], [255, 128, 128]),
    ([255, 255, 0], [210, 16, 146], [226, 0, 149]),
    ([0, 255, 255], [170, 166, 16], [179, 171, 0]),
    ([0, 255, 0], [145, 54, 34], [150, 44, 21]),
    ([255, 0, 255], [106, 202, 222], [105, 212, 235]),
    ([255, 0, 0], [81, 90, 240], [76, 85, 255]),
    ([0, 0, 255], [41, 240, 110], [29, 255, 107]),
    ([0, 0, 0], [16, 128, 128], [0, 128, 128]),
];

#[test]
fn colour_bars_have_their_published_levels() {
    for (rgb, limited, full) in BARS {
        for (range, bytes) in [(YCbCr::LIMITED, limited), (YCbCr::FULL, full)] {
            let found = range.rgb8(bytes);
            // A level of chroma is up to two of a colour.
            assert!(found.iter().zip(rgb).all(|(a, b)| a.abs_diff(b) <= 2), "{bytes:?}: {found:?}, not {rgb:?}");
        }
    }
}

#[test]
fn a_pixel_is_found_in_its_row_in_every_layout() {
    let rows = [
        (PixelFormat::Grey8, vec![9, 200], [200; 3]),
        (PixelFormat::Rgb8, vec![9, 9, 9, 250, 1, 2], [250, 1, 2]),
        (PixelFormat::Yuyv, vec![16, 128, 235, 128], [255; 3]),
        (PixelFormat::YuyvFull, vec![16, 128, 235, 128], [235; 3]),
    ];
    for (format, row, rgb) in rows {
        assert_eq!(format.rgb(&row, 1), rgb, "{format:?}");
        assert_eq!(format.ycbcr().map(|ycbcr| ycbcr.rgb8([235, 128, 128])), (row.len() == 4).then_some(rgb));
    }
    assert_eq!(PixelFormat::Yuyv.rgb(&[16, 128, 235, 128], 0), [0; 3], "black");
}
