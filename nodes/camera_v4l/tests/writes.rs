//! What is written into a camera, in which order; and what is said of it.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps")]

use camera_v4l::{
    Config, DriverFormat, Granted, Layout, Setting, StampAt, Write, differences, found, offers, part, writes, writes_of,
};
use devices::{Mode, Size};
use std::collections::BTreeMap;

/// Numbers of <linux/v4l2-controls.h>: the class user is 0x0098, the class camera 0x009a.
const EXPOSURE_AUTO: u32 = 0x009a_0901;
const EXPOSURE_ABSOLUTE: u32 = 0x009a_0902;
const EXPOSURE_AUTO_PRIORITY: u32 = 0x009a_0903;
const AUTOGAIN: u32 = 0x0098_0912;
const GAIN: u32 = 0x0098_0913;
const AUTO_WHITE_BALANCE: u32 = 0x0098_090c;
const WHITE_BALANCE_TEMPERATURE: u32 = 0x0098_091a;

fn ids(names: &[&str]) -> BTreeMap<String, u32> {
    names.iter().zip(0x0098_1000..).map(|(name, id)| ((*name).to_owned(), id)).collect()
}

fn asked() -> Config {
    Config {
        exposure_us: Some(2049.0),
        gain: Some(40),
        white_balance_k: Some(4600),
        controls: ["focus_absolute", "focus_automatic_continuous", "gone"].map(|name| (name.to_owned(), 0)).into(),
        ..Config::default()
    }
}

fn short(list: &[Write]) -> Vec<(u32, i64)> {
    list.iter().map(|write| (write.id, write.value)).collect()
}

#[test]
fn automatics_are_switched_off_before_what_they_hold() {
    let list = writes(&asked(), &ids(&["focus_absolute", "focus_automatic_continuous"]));
    assert_eq!(
        short(&list),
        [
            (EXPOSURE_AUTO, 1),
            (EXPOSURE_AUTO_PRIORITY, 0),
            (AUTOGAIN, 0),
            (AUTO_WHITE_BALANCE, 0),
            (EXPOSURE_ABSOLUTE, 20),
            (GAIN, 40),
            (WHITE_BALANCE_TEMPERATURE, 4600),
            (0x0098_1001, 0),
            (0x0098_1000, 0),
        ]
    );
}

#[test]
fn what_is_not_asked_for_is_left_alone() {
    let only = |config: Config| short(&writes(&Config { exposure_us: None, ..config }, &ids(&[])));
    assert_eq!(only(Config::default()), []);
    assert_eq!(only(Config { gain: Some(3), ..Config::default() }), [(AUTOGAIN, 0), (GAIN, 3)]);
    let exposure = Config { exposure_us: Some(10.0), ..Config::default() };
    let list = short(&writes(&exposure, &ids(&[])));
    assert_eq!(list[2], (EXPOSURE_ABSOLUTE, 1), "the shortest there is");
}

#[test]
fn while_it_follows_exposure_goes_before_gain_and_gain_only_where_its_unit_is_known() {
    let setting = Setting { exposure_us: 3000.0, gain: 2.5 };
    assert_eq!(short(&writes_of(&Config::default(), setting)), [(EXPOSURE_ABSOLUTE, 30)]);
    let config = Config { gain_unit: Some(16.0), ..Config::default() };
    assert_eq!(short(&writes_of(&config, setting)), [(EXPOSURE_ABSOLUTE, 30), (GAIN, 40)]);
}

/// All as it was asked for.
fn granted() -> Granted {
    let zero = |name: &str| (name.to_owned(), Some(0));
    Granted {
        driver: "uvcvideo".to_owned(),
        fourcc: *b"YUYV",
        width: 640,
        height: 480,
        stride: 1280,
        rate_hz: Some(30.0),
        exposure_us: Some(2000.0),
        gain: Some(40),
        white_balance_k: Some(4600),
        controls: ["focus_absolute", "focus_automatic_continuous", "gone"].map(zero).into(),
        automatics: [("exposure_automatic", 1), ("gain_automatic", 0)].map(|(name, is)| (name.to_owned(), is)).into(),
        ..Granted::default()
    }
}

#[test]
fn an_automatic_that_stays_on_and_a_refusal_and_rows_that_are_too_short_are_told() {
    assert_eq!(differences(&asked(), &granted()), []);
    let on = [("exposure_automatic", 3), ("gain_automatic", 1)].map(|(name, is)| (name.to_owned(), is)).into();
    let refused = [("gain".to_owned(), "Permission denied".to_owned())].into();
    let ill = Granted { automatics: on, refused, gain: Some(7), stride: 640, ..granted() };
    let text: Vec<String> = differences(&asked(), &ill).iter().map(ToString::to_string).collect();
    assert_eq!(
        text,
        [
            "stride: rows of 1280 bytes was asked for, the driver has set 640",
            "exposure_automatic: 1 was asked for, the driver has set 3",
            "gain_automatic: 0 was asked for, the driver has set 1",
            "gain: 40 was asked for, the driver has set 7 (Permission denied)",
        ]
    );
    let config = Config { may_differ: vec!["stride".to_owned()], ..asked() };
    assert_eq!(config.check().unwrap_err().key, "may_differ");
}

#[test]
fn what_was_found_names_all_that_was_set_and_what_is_left_to_chance() {
    let layout = Layout { format: DriverFormat::Yuyv, full_range: false, width: 640, height: 480, stride: 1344 };
    let config = Config { may_differ: vec!["gain".to_owned()], ..asked() };
    let other = Granted { gain: Some(41), ..granted() };
    let (allowed, refused) = part(&config, differences(&config, &other));
    assert_eq!(refused, []);
    let text = found(&config, &layout, &other, &allowed);
    for part in [
        "YUYV 640x480, rows of 1344 bytes (64 of them padding), levels 16 to 235, 30.00 Hz, exposed for 2000 us, gain 41",
        "white balance 4600 K, focus_absolute 0, focus_automatic_continuous 0",
        "set stamp_at = \"end\"",
        "(gain: 40 was asked for, the driver has set 41)",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let careless = Config { stamp_at: StampAt::End, exposure_us: None, white_balance_k: None, ..Config::default() };
    let text = found(&careless, &layout, &granted(), &[]);
    assert!(text.contains("set exposure_us") && text.contains("set white_balance_k"), "{text}");
    assert!(!text.contains("stamp_at"), "{text}");
}

#[test]
fn what_to_ask_for_instead_is_told() {
    let mode =
        |format: &str, size, rates_hz: &[f64]| Mode { format: format.to_owned(), size, rates_hz: rates_hz.to_vec() };
    let modes = [
        mode("MJPG", Size::Fixed(1280, 800), &[120.0, 60.0]),
        mode("YUYV", Size::Fixed(1280, 800), &[10.0]),
        mode("YUYV", Size::Between { least: (16, 16), most: (640, 480) }, &[]),
    ];
    assert_eq!(offers(&modes, *b"YUYV"), "; in YUYV it gives 1280x800 at up to 10 Hz, 16x16 to 640x480");
    assert_eq!(offers(&modes, *b"GREY"), "; it gives YUYV, MJPG");
    assert_eq!(offers(&[], *b"GREY"), "");
}
