//! The loop against a camera whose light is known.

use camera_v4l::{ExposureConfig, ExposureLoop, Setting, StripeStatistics, next_setting};
use proptest::prelude::*;
use wire::{Header, Light, Stripe, StripePeak};

/// A stripe on a thing of uneven brightness: a peak's height is 255 (light)^(1/gamma), clipped at 255.
fn stripe(setting: Setting, brightness: f64, gamma: f64, stamp_nanos: i64) -> Stripe {
    let peaks = (0..400_u32)
        .map(|k| {
            let light = setting.exposure_us * setting.gain * brightness * (0.3 + 0.7 * f64::from(k % 40) / 39.0);
            let height = 255.0 * light.powf(1.0 / gamma);
            let clipped = if height > 252.0 { StripePeak::SATURATED } else { 0 };
            StripePeak {
                u_px: 100.0,
                v_px: k as f32,
                sigma_px: 0.1,
                amplitude: height.min(255.0) as f32,
                width_px: 1.5,
                flags: StripePeak::BEST | clipped,
            }
        })
        .filter(|peak| peak.amplitude >= 12.0)
        .collect();
    let light = Light { laser: true, lamp: false };
    let header = Header { stamp_nanos, ..Header::default() };
    Stripe { header, width: 640, height: 400, light, peaks, refused: Vec::new() }
}

fn following() -> ExposureConfig {
    ExposureConfig { follow: true, ..ExposureConfig::default() }
}

#[test]
fn from_darkness_and_from_glare_the_loop_comes_to_the_target_and_stays() {
    let config = following();
    for (brightness, gamma) in [(2e-3, 1.0), (2e-4, 1.0), (1e-3, 2.2), (6e-5, 2.2), (1e-6, 1.0)] {
        for start in [100.0, 1000.0, 4000.0] {
            let mut setting = Setting { exposure_us: start, gain: 1.0 };
            let mut before = setting;
            for _ in 0..60 {
                before = setting;
                let seen = StripeStatistics::of(&stripe(setting, brightness, gamma, 0));
                setting = next_setting(&config, setting, &seen, gamma as f32);
            }
            let seen = StripeStatistics::of(&stripe(setting, brightness, gamma, 0));
            let at_its_end = setting.exposure_us == config.most_us && setting.gain == config.most_gain;
            let good = (seen.high_amplitude / config.target_peak - 1.0).abs() < 0.16 && seen.saturated_share <= 0.02;
            assert!(good || at_its_end, "{brightness} {gamma} {start}: {setting:?} {seen:?}");
            assert_eq!(before, setting, "it rests");
        }
    }
}

#[test]
fn light_comes_before_gain() {
    let config = following();
    let dark = StripeStatistics { peaks: 400, high_amplitude: 100.0, saturated_share: 0.0 };
    let next = next_setting(&config, Setting { exposure_us: 3000.0, gain: 1.0 }, &dark, 1.0);
    assert_eq!(next.exposure_us, config.most_us);
    assert!((next.gain - 1.2).abs() < 1e-6, "{next:?}");
    let glaring = StripeStatistics { peaks: 400, high_amplitude: 250.0, saturated_share: 0.5 };
    let next = next_setting(&config, next, &glaring, 1.0);
    assert_eq!(next.gain, 1.0);
    assert!(next.exposure_us < 3200.0);
}

#[test]
fn a_change_is_waited_for_and_other_pictures_say_nothing() {
    let start = Setting { exposure_us: 500.0, gain: 1.0 };
    let mut follow = ExposureLoop::new(following(), 1.0, 100.0);
    let at = |millis: i64| stripe(start, 5e-4, 1.0, millis * 1_000_000);
    assert!(follow.see(&at(0), start).is_some());
    assert_eq!(follow.see(&at(40), start), None, "8 pictures are 80 ms");
    assert!(follow.see(&at(80), start).is_some());
    let lamp = Stripe { light: Light { laser: false, lamp: true }, ..at(500) };
    assert_eq!(follow.see(&lamp, start), None);
    assert_eq!(ExposureLoop::new(ExposureConfig::default(), 1.0, 100.0).see(&at(0), start), None, "off by default");
}

proptest! {
    #[test]
    fn whatever_is_seen_the_setting_stays_within_its_bounds(
        peaks in 0_usize..1000,
        high_amplitude in prop_oneof![Just(f32::NAN), Just(0.0), -10.0_f32..5000.0],
        saturated_share in prop_oneof![Just(f32::NAN), 0.0_f32..1.0],
        exposure_us in 100.0_f64..4000.0,
        gain in 1.0_f64..4.0,
        gamma in 0.2_f32..5.0,
    ) {
        let seen = StripeStatistics { peaks, high_amplitude, saturated_share };
        let next = next_setting(&following(), Setting { exposure_us, gain }, &seen, gamma);
        prop_assert!((100.0..=4000.0).contains(&next.exposure_us), "{:?}", next);
        prop_assert!((1.0..=4.0).contains(&next.gain), "{:?}", next);
    }
}
