//! What is a peak and what is not, picture by picture.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod picture;

use picture::{Scene, frame, red_laser, rgb};
use proptest::prelude::*;
use stripe::{Config, ConfigError, StripeDetector};
use wire::{Frame, FrameError, LaserPlane, Light, PeaksPer, PixelFormat, Stripe, StripePeak};

fn detect(frame: &Frame) -> Stripe {
    StripeDetector::new(Config::default(), &red_laser(PeaksPer::Row)).unwrap().process(frame).unwrap()
}

/// A grey picture of `height` equal rows.
fn rows(width: usize, height: usize, level: impl Fn(f64) -> f64) -> Frame {
    let row: Vec<u8> = (0..width).map(|u| level(u as f64).round().clamp(0.0, 255.0) as u8).collect();
    frame(width, height, PixelFormat::Grey8, row.repeat(height))
}

fn line(u: f64, centre: f64, sigma: f64, amplitude: f64) -> f64 {
    amplitude * (-0.5 * ((u - centre) / sigma).powi(2)).exp()
}

fn reasons(stripe: &Stripe) -> Vec<&str> {
    stripe.refused.iter().map(|r| r.reason.as_str()).collect()
}

#[test]
fn a_peak_tells_place_height_and_width() {
    let stripe = detect(&rows(200, 120, |u| 20.0 + line(u, 77.3, 1.9, 120.0)));
    assert_eq!(stripe.peaks.len(), 120);
    for (v, peak) in stripe.peaks.iter().enumerate() {
        assert!(peak.is_best() && peak.v_px == v as f32 && peak.flags & StripePeak::SATURATED == 0);
        assert!((peak.u_px - 77.3).abs() < 0.02, "{peak:?}");
        assert!((peak.amplitude - 120.0).abs() < 3.0 && (peak.width_px - 1.9).abs() < 0.05, "{peak:?}");
        assert!(peak.sigma_px > 0.0 && peak.sigma_px < 0.05, "{peak:?}");
    }
}

#[test]
fn without_the_laser_there_is_nothing() {
    let mut dark = rows(200, 20, |u| 20.0 + line(u, 77.3, 1.9, 120.0));
    dark.light = Light { laser: false, lamp: true };
    let stripe = detect(&dark);
    assert!(stripe.peaks.is_empty() && stripe.refused.is_empty());
    assert_eq!((stripe.header.stamp_nanos, stripe.width, stripe.light.lamp), (40_000_000, 200, true));
}

#[test]
fn padded_rows_are_read_where_they_lie() {
    let plain = rgb(&Scene { width: 160, height: 40, ..Scene::default() }, PeaksPer::Row);
    let mut padded = plain.clone();
    padded.stride = plain.stride + 13;
    padded.data =
        plain.data.chunks(plain.stride as usize).flat_map(|row| row.iter().copied().chain([255; 13])).collect();
    assert_eq!(detect(&plain), detect(&padded));
    let unpadded_end = padded.data.len() - 13;
    padded.data.truncate(unpadded_end);
    assert_eq!(detect(&plain), detect(&padded));
}

#[test]
fn a_picture_that_contradicts_its_header_is_refused() {
    let mut short = rows(64, 8, |_| 0.0);
    short.data.pop();
    let mut detector = StripeDetector::new(Config::default(), &red_laser(PeaksPer::Row)).unwrap();
    assert!(matches!(detector.process(&short), Err(FrameError::Size { .. })));
    short.width = 0;
    assert!(matches!(detector.process(&short), Err(FrameError::Empty { .. })));
}

#[test]
fn all_lines_are_found_and_the_brightest_is_best() {
    let stripe = detect(&rows(300, 10, |u| {
        15.0 + line(u, 60.0, 1.5, 80.0) + line(u, 120.5, 2.0, 150.0) + line(u, 145.0, 2.0, 60.0)
    }));
    assert_eq!(stripe.peaks.len(), 30);
    for row in stripe.peaks.chunks(3) {
        assert!((row[0].u_px - 60.0).abs() < 0.03 && (row[1].u_px - 120.5).abs() < 0.03);
        assert!((row[2].u_px - 145.0).abs() < 0.05);
        assert_eq!(row.iter().map(StripePeak::is_best).collect::<Vec<_>>(), [false, true, false]);
    }
}

#[test]
fn of_a_tie_the_first_is_best() {
    let stripe = detect(&rows(300, 10, |u| 15.0 + line(u, 200.0, 2.0, 100.0) + line(u, 100.0, 2.0, 98.0)));
    assert!(stripe.peaks.iter().filter(|p| p.is_best()).all(|p| (p.u_px - 100.0).abs() < 0.1));
}

#[test]
fn two_clipped_lines_tie_at_full_scale() {
    // The first has a bright surrounding and less height above it.
    let glow = |u: f64| line(u, 100.0, 40.0, 90.0);
    let stripe = detect(&rows(300, 10, |u| 15.0 + glow(u) + line(u, 100.0, 3.0, 400.0) + line(u, 200.0, 3.0, 900.0)));
    let best: Vec<_> = stripe.peaks.iter().filter(|p| p.is_best()).collect();
    assert!(best.len() == 10 && best.iter().all(|p| (p.u_px - 100.0).abs() < 0.05));
    assert!(stripe.peaks.iter().all(|p| p.flags & StripePeak::SATURATED != 0));
}

#[test]
fn a_bloomed_core_is_one_line_in_the_laser_channel() {
    // The core is white, so red less the others is dark there.
    let light = |u: usize| line(u as f64, 90.4, 3.0, 1500.0);
    let clip = |value: f64| value.round().min(255.0) as u8;
    let row: Vec<u8> = (0..180)
        .flat_map(|u| [clip(10.0 + light(u)), clip(10.0 + 0.4 * light(u)), clip(10.0 + 0.3 * light(u))])
        .collect();
    let stripe = detect(&frame(180, 12, PixelFormat::Rgb8, row.repeat(12)));
    assert_eq!(stripe.peaks.len(), 12, "{stripe:?}");
    assert!(stripe.peaks.iter().all(|p| (p.u_px - 90.4).abs() < 0.15 && p.flags & StripePeak::SATURATED != 0));
}

#[test]
fn lit_areas_steps_and_hot_pixels_are_no_lines() {
    let wide = detect(&rows(300, 10, |u| if (100.0..142.0).contains(&u) { 255.0 } else { 10.0 }));
    assert!(wide.peaks.is_empty() && reasons(&wide) == ["peak wider than a laser line"]);
    let step = detect(&rows(300, 10, |u| if u < 150.0 { 20.0 } else { 200.0 }));
    assert!(step.peaks.is_empty() && step.refused.is_empty());
    let ramp = detect(&rows(300, 10, |u| 0.8 * u));
    assert!(ramp.peaks.is_empty() && ramp.refused.is_empty());
    let config = Config { min_width_px: 0.8, ..Config::default() };
    let hot = StripeDetector::new(config, &red_laser(PeaksPer::Row))
        .unwrap()
        .process(&rows(300, 10, |u| if u == 70.0 { 200.0 } else { 10.0 }))
        .unwrap();
    assert!(hot.peaks.is_empty() && reasons(&hot) == ["peak narrower than a laser line"]);
    let cut = detect(&rows(300, 10, |u| 10.0 + line(u, 1.0, 2.0, 100.0)));
    assert!(cut.peaks.is_empty(), "{cut:?}");
}

#[test]
fn a_line_hardly_wider_than_a_pixel_is_found_at_any_phase() {
    for phase in 0..10 {
        let centre = 100.0 + 0.1 * f64::from(phase);
        // Averaged over each pixel, in tenths of it.
        let level = |u: f64| (0..10).map(|i| line(u + 0.1 * f64::from(i) - 0.45, centre, 0.5, 15.0)).sum::<f64>();
        let stripe = detect(&rows(200, 120, |u| 20.0 + level(u)));
        assert_eq!(stripe.peaks.len(), 120, "{:?}", stripe.refused);
        let off = f64::from(stripe.peaks[60].u_px) - centre;
        assert!(off.abs() < 0.02, "{off} px off at {centre}, {:?}", stripe.peaks[60]);
    }
}

#[test]
fn ambient_light_on_a_slope_moves_no_line() {
    let stripe = detect(&rows(300, 10, |u| 10.0 + 0.5 * u + line(u, 150.25, 2.0, 80.0)));
    assert!(stripe.peaks.len() == 10 && stripe.peaks.iter().all(|p| (p.u_px - 150.25).abs() < 0.03));
}

#[test]
fn steps_and_corners_along_the_stripe_are_not_smeared() {
    let centre = |v: usize| match v {
        0..30 => 100.0,
        30..60 => 102.0,
        _ => 102.0 + 0.7 * (v as f64 - 60.0),
    };
    let data =
        (0..90).flat_map(|v| (0..200).map(move |u| (10.0 + line(u as f64, centre(v), 1.8, 120.0)).round() as u8));
    let stripe = detect(&frame(200, 90, PixelFormat::Grey8, data.collect()));
    assert_eq!(stripe.peaks.len(), 90);
    for (v, peak) in stripe.peaks.iter().enumerate() {
        assert!((f64::from(peak.u_px) - centre(v)).abs() < 0.06, "row {v}: {peak:?}");
    }
}

#[test]
fn crowded_rows_keep_the_largest_and_count_the_rest() {
    let stripe = detect(&rows(640, 6, |u| {
        10.0 + (0..12).map(|i| line(u, 30.0 + 50.0 * f64::from(i), 1.5, 50.0 + 10.0 * f64::from(i))).sum::<f64>()
    }));
    assert_eq!(stripe.peaks.len(), 6 * 8);
    assert!(stripe.peaks.iter().all(|p| p.u_px > 200.0));
    assert_eq!((reasons(&stripe), stripe.refused[0].count), (vec!["more peaks in a line than are kept"], 24));
}

/// A stripe in the upper half alone, and in every row a grain that is brighter, each at a place of its own.
fn grainy() -> Frame {
    let mut random = picture::Random(3);
    let data = (0..80).flat_map(|v| {
        let grain = 150.0 + 140.0 * random.uniform();
        let stripe = if v < 40 { 90.0 } else { 0.0 };
        (0..300).map(move |u| {
            let u = f64::from(u);
            (10.0 + line(u, 60.0 + 0.8 * f64::from(v), 1.5, stripe) + line(u, grain, 1.0, 120.0)).round() as u8
        })
    });
    frame(300, 80, PixelFormat::Grey8, data.collect())
}

#[test]
fn a_grain_that_no_line_goes_on_from_is_no_peak_however_bright() {
    let stripe = detect(&grainy());
    assert_eq!(stripe.peaks.len(), 40, "{:?}", stripe.refused);
    for (v, peak) in stripe.peaks.iter().enumerate() {
        assert!(peak.is_best() && (f64::from(peak.u_px) - 60.0 - 0.8 * v as f64).abs() < 0.05, "row {v}: {peak:?}");
    }
    assert_eq!((reasons(&stripe), stripe.refused[0].count), (vec!["peak that no line goes on from"], 80));
    let config = Config { min_support_lines: 0, ..Config::default() };
    let all = StripeDetector::new(config, &red_laser(PeaksPer::Row)).unwrap().process(&grainy()).unwrap();
    assert_eq!((all.peaks.len(), all.refused.len()), (120, 0), "asked for none, each grain is a peak");
}

#[test]
fn grains_push_no_line_out_of_a_crowded_row() {
    // Ten grains in each row, each somewhere in its own two hundred pixels and all brighter than the line between them.
    let mut random = picture::Random(7);
    let data = (0..40).flat_map(|v| {
        let grains: Vec<f64> = (0..10).map(|i| 260.0 + 200.0 * f64::from(i) + 140.0 * random.uniform()).collect();
        (0..2300).map(move |u| {
            let u = f64::from(u);
            let grains: f64 = grains.iter().map(|centre| line(u, *centre, 1.0, 120.0)).sum();
            (10.0 + line(u, 100.0 + 0.5 * f64::from(v), 1.5, 60.0) + grains).round() as u8
        })
    });
    let stripe = detect(&frame(2300, 40, PixelFormat::Grey8, data.collect()));
    let near = |p: &&StripePeak| (p.u_px - 100.0 - 0.5 * p.v_px).abs() < 0.05;
    assert_eq!(stripe.peaks.iter().filter(near).count(), 40, "{:?}", stripe.refused);
}

#[test]
fn a_line_with_gaps_and_a_short_line_stay() {
    // Every third row dark, which costs two peaks at either end; and five rows of a line alone.
    let lit = |v: usize| (v < 60 && !v.is_multiple_of(3)) || (70..75).contains(&v);
    let data = (0..90).flat_map(|v| {
        (0..200).map(move |u| (10.0 + if lit(v) { line(f64::from(u), 90.3, 1.8, 120.0) } else { 0.0 }).round() as u8)
    });
    let stripe = detect(&frame(200, 90, PixelFormat::Grey8, data.collect()));
    assert_eq!(stripe.peaks.len(), 36 + 5, "{:?}", stripe.refused);
}

#[test]
fn the_same_picture_gives_the_same_bytes_whatever_came_before() {
    let first = rgb(&Scene { width: 320, height: 64, ..Scene::default() }, PeaksPer::Row);
    let second =
        rgb(&Scene { width: 200, height: 90, seed: 9, speckle_contrast: 0.1, ..Scene::default() }, PeaksPer::Row);
    let mut detector = StripeDetector::new(Config::default(), &red_laser(PeaksPer::Row)).unwrap();
    detector.process(&first).unwrap();
    assert_eq!(detector.process(&second).unwrap(), detect(&second));
}

#[test]
fn what_cannot_work_is_named() {
    let bad = Config { max_width_px: 0.1, ..Config::default() };
    assert!(bad.check().unwrap_err().to_string().starts_with("[stripe] max_width_px = 0.1"));
    assert!(Config { min_amplitude: f32::NAN, ..Config::default() }.check().is_err());
    for weights in [[0.0; 3], [-1.0, 0.0, 0.0], [f64::NAN, 1.0, 1.0], [1e9, 1.0, 1.0]] {
        let laser = LaserPlane { channel_weights: weights, ..red_laser(PeaksPer::Row) };
        assert!(matches!(StripeDetector::new(Config::default(), &laser), Err(ConfigError::Weights(_))));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_bytes_give_finite_peaks_in_order(
        width in 1u32..70,
        height in 1u32..40,
        layout in 0..4usize,
        column: bool,
        clipped in 0..4u8,
        seed: u64,
    ) {
        let format = [PixelFormat::Grey8, PixelFormat::Rgb8, PixelFormat::Yuyv, PixelFormat::YuyvFull][layout];
        let mut random = picture::Random(seed);
        let count = format.row_bytes(width) * height as usize;
        // Some pictures are clipped for the most part.
        let data = (0..count).map(|_| (random.uniform() * 256.0 * f64::from(1 + clipped)).min(255.0) as u8).collect();
        let peaks_per = if column { PeaksPer::Column } else { PeaksPer::Row };
        let config = Config { min_amplitude: 1.0, min_noise_ratio: 1.0, min_width_px: 0.2, ..Config::default() };
        let mut detector = StripeDetector::new(config, &red_laser(peaks_per)).unwrap();
        let stripe = detector.process(&frame(width as usize, height as usize, format, data)).unwrap();
        let mut last = [-1.0, -1.0];
        for peak in stripe.peaks.iter() {
            let here = if column { [peak.u_px, peak.v_px] } else { [peak.v_px, peak.u_px] };
            prop_assert!(here[0] > last[0] || (here[0] == last[0] && here[1] > last[1]), "{:?} after {:?}", here, last);
            last = here;
            prop_assert!(peak.sigma_px.is_finite() && peak.sigma_px > 0.0 && peak.amplitude > 0.0);
            prop_assert!((-1.0..=width as f32).contains(&peak.u_px) && (-1.0..=height as f32).contains(&peak.v_px));
        }
    }
}
