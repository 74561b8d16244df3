//! The first stage on one picture, as a user has it: against a line that is known.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use image::{Rgb, RgbImage};
use system_tests::{limn, repository, succeed};

const SIZE: (u32, u32) = (640, 480);
const SIGMA_PX: f64 = 1.3;

/// Where the line runs in row `v`.
fn line_px(v: f64) -> f64 {
    300.0 + 40.0 * (v / 90.0).sin()
}

/// A red line of Gaussian cross-section on a dark ground, integrated over each pixel.
fn picture() -> RgbImage {
    let bell = |x: f64| 0.5 * (1.0 + erf(x / (SIGMA_PX * std::f64::consts::SQRT_2)));
    RgbImage::from_fn(SIZE.0, SIZE.1, |u, v| {
        let from_line = f64::from(u) - line_px(f64::from(v));
        let light =
            180.0 * SIGMA_PX * (2.0 * std::f64::consts::PI).sqrt() * (bell(from_line + 0.5) - bell(from_line - 0.5));
        Rgb([(12.0 + light).round() as u8, 14, 12])
    })
}

/// Abramowitz and Stegun 7.1.26: good to 1.5e-7.
fn erf(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x.abs());
    let terms = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    let sum = terms.iter().rev().fold(0.0, |sum, term| t * (term + sum));
    (1.0 - sum * (-x * x).exp()).copysign(x)
}

#[test]
fn the_line_in_a_picture_is_found_to_a_twentieth_of_a_pixel() {
    let folder = tempfile::tempdir().unwrap();
    let (image, marked) = (folder.path().join("line.png"), folder.path().join("marked.png"));
    formats::image_file::write_rgb(&image, &picture()).unwrap();
    let rig = repository("config/rigs/fine.toml");
    let output = succeed(limn().arg("stripe").arg(&image).arg("--rig").arg(rig).arg("--picture").arg(&marked));
    let table = String::from_utf8(output.stdout).unwrap();
    let mut rows = table.lines();
    assert_eq!(rows.next(), Some("u_px,v_px,sigma_px,amplitude,width_px,best,saturated"));
    let peaks: Vec<Vec<f64>> = rows.map(|row| row.split(',').map(|field| field.parse().unwrap()).collect()).collect();
    let best: Vec<&Vec<f64>> = peaks.iter().filter(|peak| peak[5] == 1.0).collect();
    assert!(best.len() > 470, "{} rows of 480", best.len());
    let square = |peak: &&Vec<f64>| (peak[0] - line_px(peak[1])).powi(2);
    let rms_px = (best.iter().map(square).sum::<f64>() / best.len() as f64).sqrt();
    println!("{} peaks, rms {rms_px:.4} px", best.len());
    assert!(rms_px < 0.05, "{rms_px} px");
    let green = image::open(marked).unwrap().to_rgb8().pixels().filter(|pixel| pixel.0 == [0, 255, 0]).count();
    assert_eq!(green, best.len());
}

#[test]
fn a_picture_without_a_line_and_a_file_that_is_none_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let (dark, none) = (folder.path().join("dark.png"), folder.path().join("none.png"));
    formats::image_file::write_rgb(&dark, &RgbImage::from_pixel(64, 48, Rgb([9; 3]))).unwrap();
    std::fs::write(&none, b"no picture").unwrap();
    for (path, reason) in [(&dark, "no stripe"), (&none, "none.png")] {
        let output = limn().arg("stripe").arg(path).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains(reason) && !said.contains("panicked"), "{said}");
    }
}
