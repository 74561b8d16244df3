//! Pictures of a textured thing under laser and lamp in turn, through a hand's motion and a rolling shutter.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use camera_v4l::{BANDS, LightConfig, LightJudge, Look, look};
use proptest::prelude::*;
use wire::{Clock, Frame, Header, LaserPlane, Light, PeaksPer, Phase, PixelFormat};

const WIDTH: u32 = 320;
const HEIGHT: u32 = 240;
const LAMP_EVERY: u64 = 6;

fn laser(peaks_per: PeaksPer) -> LaserPlane {
    LaserPlane { normal: [1.0, 0.0, 0.0], distance_m: 0.1, channel_weights: [1.0, -0.5, -0.5], peaks_per }
}

/// Reflectance of the thing in red, green and blue: soft grey texture, red blots, and print with sharp edges.
fn albedo(u: f64, v: f64) -> [f64; 3] {
    let soft = 0.45 + 0.2 * (u / 17.0).sin() * (v / 23.0).cos();
    let red = f64::from(u8::from((u / 31.0).sin() + (v / 29.0).sin() > 1.4));
    let print = if (u / 7.0).sin() * (v / 5.0).sin() > 0.9 { 0.3 } else { 1.0 };
    [soft * print, soft * print * (1.0 - 0.6 * red), soft * print * (1.0 - 0.6 * red)]
}

/// A picture of moment `k`: rows from `switch` on are lit as the next picture will be.
fn picture(k: u64, switch: u32, format: PixelFormat, peaks_per: PeaksPer) -> Frame {
    let is_lamp = |k: u64| k.is_multiple_of(LAMP_EVERY);
    let shift = 60.0 * (k as f64 / 40.0).sin();
    let mut rgb = Vec::new();
    for v in 0..HEIGHT {
        for u in 0..WIDTH {
            let lamp = is_lamp(if v < switch { k } else { k + 1 });
            let (across, along) = match peaks_per {
                PeaksPer::Row => (u, v),
                PeaksPer::Column => (v, u),
            };
            let (x, y) = (f64::from(u) + shift, f64::from(v) + 0.3 * shift);
            // Half of what is seen is far behind, and dark.
            let far = if (x / 40.0).sin() > 0.2 { 0.1 } else { 1.0 };
            let from_middle = f64::from(across) - 120.0 - 25.0 * ((f64::from(along) + shift) / 50.0).sin();
            let line = (-from_middle * from_middle / 4.5).exp();
            for (channel, part) in albedo(x, y).into_iter().enumerate() {
                let red = if channel == 0 { 330.0 } else { 25.0 };
                let light = if lamp { 190.0 * far } else { red * line } + 6.0;
                rgb.push((part * light).clamp(0.0, 255.0) as u8);
            }
        }
    }
    let data: Vec<u8> = match format {
        PixelFormat::Rgb8 => rgb,
        PixelFormat::Grey8 => rgb.chunks_exact(3).map(|c| luminance(c) as u8).collect(),
        PixelFormat::Yuyv => rgb.chunks_exact(6).flat_map(yuyv).enumerate().map(limited).collect(),
        PixelFormat::YuyvFull => rgb.chunks_exact(6).flat_map(yuyv).collect(),
    };
    Frame {
        header: Header { clock: Clock::System, ..Header::default() },
        width: WIDTH,
        height: HEIGHT,
        stride: format.row_bytes(WIDTH) as u32,
        format,
        light: Light { laser: false, lamp: false },
        exposure_nanos: 1_000_000,
        gain: 1.0,
        gamma: 1.0,
        data: data.into(),
    }
}

fn luminance(c: &[u8]) -> f64 {
    0.299 * f64::from(c[0]) + 0.587 * f64::from(c[1]) + 0.114 * f64::from(c[2])
}

/// A byte of YUYV in the limited range.
fn limited((at, full): (usize, u8)) -> u8 {
    let levels = if at.is_multiple_of(2) { 219.0 } else { 224.0 };
    (16.0 + f64::from(full) * levels / 255.0).round() as u8
}

fn yuyv(pair: &[u8]) -> [u8; 4] {
    let (left, right) = (&pair[..3], &pair[3..]);
    let chroma = |channel: usize, scale: f64| {
        (128.0 + scale * (f64::from(left[channel]) - luminance(left))).clamp(0.0, 255.0) as u8
    };
    [luminance(left) as u8, chroma(2, 0.564), luminance(right) as u8, chroma(0, 0.713)]
}

#[test]
fn laser_and_lamp_in_turn_are_told_by_the_picture_in_every_format() {
    let config = LightConfig::default();
    for format in [PixelFormat::Rgb8, PixelFormat::Yuyv, PixelFormat::YuyvFull, PixelFormat::Grey8] {
        for peaks_per in [PeaksPer::Row, PeaksPer::Column] {
            let mut judge = LightJudge::default();
            let mut wrong = 0;
            for k in 0..60 {
                let frame = picture(k, HEIGHT, format, peaks_per);
                let told = judge.judge(Phase::Both, &look(&frame, &laser(peaks_per), &config).unwrap(), &config);
                let lamp = k.is_multiple_of(LAMP_EVERY);
                // It has to have seen both.
                if k > 12 && told != (Light { laser: !lamp, lamp }) {
                    wrong += 1;
                    println!("{format:?} {peaks_per:?} picture {k}: {told:?}");
                }
            }
            assert_eq!(wrong, 0, "{format:?} {peaks_per:?}");
        }
    }
}

#[test]
fn a_picture_in_which_the_light_was_switched_is_not_taken_for_colour() {
    let config = LightConfig::default();
    for switch in [40, 120, 200] {
        let mut judge = LightJudge::default();
        for k in 0..72 {
            // Every second round of the lamp, it is switched in the middle.
            let torn = k / LAMP_EVERY % 2 == 1 && (k + 1) % LAMP_EVERY <= 1;
            let rows = if torn { switch } else { HEIGHT };
            let frame = picture(k, rows, PixelFormat::Rgb8, PeaksPer::Row);
            let told = judge.judge(Phase::Both, &look(&frame, &laser(PeaksPer::Row), &config).unwrap(), &config);
            if k > 24 && torn {
                assert!(told.laser || !told.lamp, "switched at row {switch}, picture {k}: {told:?}");
            }
        }
    }
}

#[test]
fn outside_of_both_the_phase_has_the_last_word_where_the_picture_says_nothing() {
    let config = LightConfig::default();
    let dark = Look { stripe_share: 0.0, brightness: [5.0; BANDS] };
    let lined = Look { stripe_share: 0.7, ..dark };
    let judge = |phase, seen: &Look| {
        let light = LightJudge::default().judge(phase, seen, &config);
        (light.laser, light.lamp)
    };
    assert_eq!(judge(Phase::Shape, &dark), (true, false));
    assert_eq!(judge(Phase::Colour, &dark), (false, true));
    assert_eq!(judge(Phase::Colour, &lined), (true, false), "the laser was still on");
    assert_eq!(judge(Phase::Both, &dark), (true, false), "a line may be there that is not seen from afar");
    assert_eq!(judge(Phase::Both, &lined), (true, false));
}

proptest! {
    #[test]
    fn any_picture_can_be_looked_at(
        width in 1_u32..70,
        height in 1_u32..70,
        format in proptest::sample::select(vec![
            PixelFormat::Grey8,
            PixelFormat::Rgb8,
            PixelFormat::Yuyv,
            PixelFormat::YuyvFull,
        ]),
        columns in any::<bool>(),
        seed in any::<u8>(),
        bytes in 0_usize..20_000,
    ) {
        let data: Vec<u8> = (0..bytes).map(|k| (k as u8).wrapping_mul(seed)).collect();
        let stride = format.row_bytes(width) as u32;
        let base = picture(0, 0, PixelFormat::Grey8, PeaksPer::Row);
        let frame = Frame { width, height, stride, format, data: data.into(), ..base };
        let peaks_per = if columns { PeaksPer::Column } else { PeaksPer::Row };
        let seen = look(&frame, &laser(peaks_per), &LightConfig::default());
        prop_assert_eq!(seen.is_ok(), frame.check().is_ok());
        if let Ok(seen) = seen {
            prop_assert!((0.0..=1.0).contains(&seen.stripe_share));
        }
    }
}
