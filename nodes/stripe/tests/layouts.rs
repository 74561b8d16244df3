//! The same line in every layout of bytes, and in both ranges of Y'CbCr.

#![allow(clippy::unwrap_used, dead_code, reason = "helpers of tests")]

mod picture;

use picture::{frame, red_laser};
use stripe::{Config, StripeDetector};
use wire::{Frame, LaserPlane, PeaksPer, PixelFormat, StripePeak};

fn line(u: f64, centre: f64, sigma: f64, amplitude: f64) -> f64 {
    amplitude * (-0.5 * ((u - centre) / sigma).powi(2)).exp()
}

#[test]
fn every_layout_of_bytes_gives_the_same_line() {
    let (width, height) = (201, 24);
    let level = |u: usize| (20.0 + line(u as f64, 77.3, 1.9, 120.0)).round() as u8;
    let pixels = |f: &dyn Fn(usize) -> Vec<u8>| (0..width).flat_map(f).collect::<Vec<u8>>().repeat(height);
    let grey = frame(width, height, PixelFormat::Grey8, pixels(&|u| vec![level(u)]));
    let rgb = frame(width, height, PixelFormat::Rgb8, pixels(&|u| vec![level(u), 20, 20]));
    let mut yuyv_row: Vec<u8> = (0..width).flat_map(|u| [level(u), 128]).collect();
    yuyv_row.extend([20, 128]);
    let yuyv = frame(width, height, PixelFormat::YuyvFull, yuyv_row.repeat(height));
    for (picture, weights) in [(grey, [1.0, -0.5, -0.5]), (rgb, [1.0, -0.5, -0.5]), (yuyv, [0.3, 0.4, 0.3])] {
        let laser = LaserPlane { channel_weights: weights, ..red_laser(PeaksPer::Row) };
        let stripe = StripeDetector::new(Config::default(), &laser).unwrap().process(&picture).unwrap();
        assert_eq!(stripe.peaks.len(), height, "{:?}", picture.format);
        assert!(stripe.peaks.iter().all(|p| (p.u_px - 77.3).abs() < 0.02 && (p.amplitude - 120.0).abs() < 3.0));
    }
}

/// Rows of YUYV, all of one colour, with a line of brightness over black.
fn yuyv_rows(format: PixelFormat, chroma: [u8; 2], level: impl Fn(f64) -> f64) -> Frame {
    let row: Vec<u8> = (0..200).flat_map(|u| [level(f64::from(u)).round() as u8, chroma[(u % 2) as usize]]).collect();
    frame(200, 24, format, row.repeat(24))
}

#[test]
fn levels_of_yuyv_count_as_what_they_stand_for() {
    // 219 levels from black to white in the limited range, 255 in the full one.
    for (format, scale) in [(PixelFormat::Yuyv, 255.0 / 219.0), (PixelFormat::YuyvFull, 1.0)] {
        // Both formats: grey, weighed by all three channels; and a red tint that the weights tell from it.
        for (chroma, weights) in [([128, 128], [0.3, 0.4, 0.3]), ([120, 160], [1.0, 0.0, 0.0])] {
            let picture = yuyv_rows(format, chroma, |u| 40.0 + line(u, 77.3, 1.9, 100.0));
            let laser = LaserPlane { channel_weights: weights, ..red_laser(PeaksPer::Row) };
            let stripe = StripeDetector::new(Config::default(), &laser).unwrap().process(&picture).unwrap();
            assert_eq!(stripe.peaks.len(), 24, "{format:?}");
            for peak in stripe.peaks.iter() {
                assert!((peak.amplitude as f64 - 100.0 * scale).abs() < 3.0 && (peak.u_px - 77.3).abs() < 0.02);
                assert_eq!(peak.flags & StripePeak::SATURATED, 0);
            }
        }
    }
}

#[test]
fn white_of_the_limited_range_is_clipped_and_the_same_byte_of_the_full_range_is_not() {
    // Green alone is clipped where there is no more red to it: the colour decides with the brightness.
    for (chroma, top) in [([128, 128], 235.0), ([54, 34], 145.0)] {
        let level = move |u: f64| (40.0 + line(u, 77.3, 3.0, 400.0)).min(top);
        for (format, clipped) in [(PixelFormat::Yuyv, true), (PixelFormat::YuyvFull, false)] {
            let laser = LaserPlane { channel_weights: [0.0, 1.0, 0.0], ..red_laser(PeaksPer::Row) };
            let picture = yuyv_rows(format, chroma, level);
            let stripe = StripeDetector::new(Config::default(), &laser).unwrap().process(&picture).unwrap();
            assert_eq!(stripe.peaks.len(), 24);
            let flagged = |peak: &StripePeak| peak.flags & StripePeak::SATURATED != 0;
            assert!(stripe.peaks.iter().all(|peak| flagged(peak) == clipped), "{format:?} {chroma:?}");
        }
    }
}
