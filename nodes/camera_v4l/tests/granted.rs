//! What was asked for and what was set.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use camera_v4l::{Config, DriverFormat, Granted, Trouble, allowance, differences, part};
use std::io::Error;
use std::path::Path;

fn asked() -> Config {
    toml::from_str(
        r#"
        device = "/dev/v4l/by-id/usb-camera"
        format = "MJPG"
        width = 641
        height = 479
        rate_hz = 30
        exposure_us = 2000
        gain = 40
        white_balance_k = 4600
        controls = { sharpness = 0, no_such_thing = 3 }
        may_differ = ["rate", "no_such_thing"]
        "#,
    )
    .unwrap()
}

/// As vivid answered, and then some.
fn set() -> Granted {
    Granted {
        fourcc: *b"YUYV",
        width: 640,
        height: 480,
        stride: 1280,
        rate_hz: Some(25.0),
        exposure_us: Some(3000.0),
        gain: Some(255),
        white_balance_k: None,
        controls: [("sharpness".to_owned(), Some(2)), ("no_such_thing".to_owned(), None)].into(),
        ..Granted::default()
    }
}

#[test]
fn every_silent_substitution_has_its_sentence() {
    let config = asked();
    let (allowed, refused) = part(&config, differences(&config, &set()));
    let text: Vec<String> = refused.iter().map(ToString::to_string).collect();
    assert_eq!(
        text,
        [
            "format: MJPG was asked for, the driver has set YUYV",
            "size: 641x479 was asked for, the driver has set 640x480",
            "exposure: 2000 us was asked for, the driver has set 3000 us",
            "gain: 40 was asked for, the driver has set 255",
            "white_balance: 4600 was asked for, and the camera has no such setting, or does not tell it",
            "sharpness: 0 was asked for, the driver has set 2",
        ]
    );
    let allow = allowance(&refused);
    assert!(allow.starts_with(", or add \"format\", \"exposure\"") && !allow.contains("size"), "{allow}");
    assert_eq!(allowance(&[]), "");
    let text: Vec<String> = allowed.iter().map(ToString::to_string).collect();
    assert_eq!(
        text,
        [
            "rate: 30 Hz was asked for, the driver has set 25.00 Hz",
            "no_such_thing: 3 was asked for, and the camera has no such setting, or does not tell it",
        ]
    );
}

#[test]
fn what_was_granted_is_no_difference() {
    let config = asked();
    let granted = Granted {
        fourcc: config.format.fourcc(),
        width: 641,
        height: 479,
        stride: 0,
        rate_hz: Some(29.97),
        exposure_us: Some(2000.0),
        gain: Some(40),
        white_balance_k: Some(4600),
        controls: [("sharpness".to_owned(), Some(0)), ("no_such_thing".to_owned(), Some(3))].into(),
        ..Granted::default()
    };
    assert_eq!(differences(&config, &granted), []);
    // What nobody asked for may be anything.
    let config = Config { format: DriverFormat::Yuyv, rate_hz: 25.0, ..Config::default() };
    assert_eq!(differences(&config, &Granted { controls: [].into(), ..set() }), []);
}

#[test]
fn every_trouble_says_what_to_do() {
    let device = Path::new("/dev/video9");
    let opening = |code| Trouble::opening(device, "opening", &Error::from_raw_os_error(code)).to_string();
    let streaming = |code| Trouble::streaming(device, &Error::from_raw_os_error(code)).to_string();
    for (text, advice) in [
        (opening(2), "limn devices"),
        (opening(13), "may not be opened by this user"),
        (opening(16), "fuser /dev/video9"),
        (opening(25), "is no camera"),
        (opening(19), "plug it in again"),
        (streaming(19), "plug it in again"),
        (streaming(5), "another USB port"),
        (Trouble::Format { device: device.into(), fourcc: "H264".to_owned() }.to_string(), "set format to GREY, YUYV"),
        (Trouble::Silent { device: device.into(), seconds: 1 }.to_string(), "a shorter cable"),
    ] {
        assert!(text.contains(advice) && text.contains("/dev/video9"), "{text}");
    }
}

#[test]
fn what_no_camera_can_do_is_refused_with_its_key() {
    Config::default().check().unwrap();
    for (text, key) in [
        ("device = \"\"", "device"),
        ("width = 0", "width"),
        ("height = 100000", "height"),
        ("rate_hz = nan", "rate_hz"),
        ("buffers = 1", "buffers"),
        ("may_differ = [\"rate\", \"size\"]", "may_differ"),
        ("exposure_us = -5", "exposure_us"),
        ("gamma = 0", "gamma"),
        ("exposure = { follow = true }", "exposure.follow"),
        ("exposure = { least_us = 100, most_us = 50 }", "exposure.least_us"),
        ("light = { stripe_share = 2 }", "light.stripe_share"),
    ] {
        let config: Config = toml::from_str(text).unwrap();
        assert_eq!(config.check().unwrap_err().key, key);
    }
    assert!(toml::from_str::<Config>("format = \"H264\"").unwrap_err().to_string().contains("YUYV"));
    assert!(toml::from_str::<Config>("expsure_us = 1").is_err());
}
