//! What was found and set, in words.

use crate::config::Config;
use crate::granted::{Difference, Granted};
use crate::pixels::{DriverFormat, Layout};
use crate::stamp::StampAt;
use devices::{Mode, Size};

/// The driver of webcams. It flags its stamps as those of the start of the exposure; they are of the first bytes that come.
const WEBCAM: &str = "uvcvideo";

/// What an open camera is set to, what differs from what was asked for as it may, and what is left to chance.
pub fn found(config: &Config, layout: &Layout, granted: &Granted, allowed: &[Difference]) -> String {
    let Layout { format, full_range, width, height, stride } = layout;
    let mut text = format!("{}: {format} {width}x{height}, rows of {stride} bytes", config.device.display());
    let padding = format.least_stride(*width).map_or(0, |tight| (*stride as usize).saturating_sub(tight));
    if padding > 0 {
        text += &format!(" ({padding} of them padding)");
    }
    if *format == DriverFormat::Yuyv {
        text += if *full_range { ", levels 0 to 255" } else { ", levels 16 to 235" };
        if let Some(colours) = &granted.other_colours {
            text += &format!(" ({colours}, read as BT.601: greens and reds are some levels off)");
        }
    }
    if let Some(rate_hz) = granted.rate_hz {
        text += &format!(", {rate_hz:.2} Hz");
    }
    match (config.exposure_us, granted.exposure_us) {
        (Some(_), Some(us)) => text += &format!(", exposed for {us} us"),
        (Some(us), None) => text += &format!(", exposed for {us} us, as the configuration has it"),
        (None, _) => text += ", exposure left to the camera: set exposure_us, or stamps are off by half of it",
    }
    if let Some(gain) = granted.gain {
        text += &format!(", gain {gain}");
    }
    match (config.white_balance_k, granted.white_balance_k) {
        (_, None) => {}
        (Some(_), Some(kelvin)) => text += &format!(", white balance {kelvin} K"),
        (None, Some(_)) => text += ", white balance left to the camera: set white_balance_k, or colours drift",
    }
    for (name, value) in &granted.controls {
        text += &value.map_or_else(String::new, |value| format!(", {name} {value}"));
    }
    if granted.driver == WEBCAM && config.stamp_at == StampAt::Driver {
        text += "; a webcam's stamps are of the end of the exposure, whatever it says: set stamp_at = \"end\"";
    }
    for (name, reason) in &granted.refused {
        text += &format!("; to setting {name} the driver said: {reason}");
    }
    if !allowed.is_empty() {
        text += &format!(" ({})", sentence(allowed));
    }
    text
}

/// Differences, one after the other.
pub fn sentence(differences: &[Difference]) -> String {
    differences.iter().map(Difference::to_string).collect::<Vec<_>>().join("; ")
}

/// What a camera gives in a format, as the rest of a sentence: what to ask for instead of a size or a rate that it has not.
pub fn offers(modes: &[Mode], fourcc: [u8; 4]) -> String {
    let format = String::from_utf8_lossy(&fourcc).into_owned();
    let of_format: Vec<String> = modes.iter().filter(|mode| mode.format == format).map(size_and_rates).collect();
    if !of_format.is_empty() {
        return format!("; in {format} it gives {}", of_format.join(", "));
    }
    let given = |format: &DriverFormat| modes.iter().any(|mode| mode.format == format.to_string());
    let formats: Vec<String> =
        DriverFormat::ALL.iter().filter(|format| given(format)).map(DriverFormat::to_string).collect();
    if formats.is_empty() { String::new() } else { format!("; it gives {}", formats.join(", ")) }
}

fn size_and_rates(mode: &Mode) -> String {
    let size = match mode.size {
        Size::Fixed(width, height) => format!("{width}x{height}"),
        Size::Between { least: (w, h), most: (width, height) } => format!("{w}x{h} to {width}x{height}"),
    };
    let most_hz = mode.rates_hz.iter().copied().fold(0.0, f64::max);
    if most_hz > 0.0 { format!("{size} at up to {} Hz", (most_hz * 100.0).round() / 100.0) } else { size }
}
