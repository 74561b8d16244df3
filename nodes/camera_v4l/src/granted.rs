//! What was asked of the camera, and what the driver made of it: drivers replace what they cannot do in silence.

use crate::config::Config;
use crate::pixels::DriverFormat;
use crate::writes::automatics;
use std::collections::BTreeMap;
use std::fmt;

/// What the driver says it has set, read back.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Granted {
    /// The kernel's name of the driver.
    pub driver: String,
    /// The four letters of its format.
    pub fourcc: [u8; 4],
    /// Its Y'CbCr is over all levels, by V4L2's rules.
    pub full_range: bool,
    /// The colours that it has where they are not those of BT.601, in its words.
    pub other_colours: Option<String>,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Bytes from one row to the next.
    pub stride: u32,
    /// Pictures a second; none when the camera does not tell.
    pub rate_hz: Option<f64>,
    /// None when it has no such control, or is left to itself.
    pub exposure_us: Option<f64>,
    /// In the camera's steps.
    pub gain: Option<i64>,
    /// In kelvin.
    pub white_balance_k: Option<i64>,
    /// The controls that were asked for by name; none where there is no such control, or it cannot be read.
    pub controls: BTreeMap<String, Option<i64>>,
    /// The automatics that should be off, as they are; those that the camera has.
    pub automatics: BTreeMap<String, i64>,
    /// The driver's words to settings that it refused.
    pub refused: BTreeMap<String, String>,
}

/// One thing that is not as it was asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// As `may_differ` names it.
    pub name: String,
    /// What was asked for.
    pub asked: String,
    /// What was set.
    pub set: Option<String>,
    /// What the driver said to it.
    pub reason: Option<String>,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, asked, set, reason } = self;
        match set {
            Some(set) => write!(f, "{name}: {asked} was asked for, the driver has set {set}")?,
            None => {
                write!(f, "{name}: {asked} was asked for, and the camera has no such setting, or does not tell it")?
            }
        }
        reason.iter().try_for_each(|reason| write!(f, " ({reason})"))
    }
}

/// A picture of another size fits no rig.
pub(crate) const SIZE: &str = "size";
/// Rows that are too short hold no picture.
pub(crate) const STRIDE: &str = "stride";
/// Rates are fractions of whole numbers.
const RATE_TOLERANCE: f64 = 0.01;
/// Exposure comes in steps of 100 us from most cameras.
const EXPOSURE_STEP_US: f64 = 50.1;

/// Everything that is not as it was asked for.
pub fn differences(asked: &Config, granted: &Granted) -> Vec<Difference> {
    let mut found = Vec::new();
    let mut note = |same: bool, name: &str, asked: String, set: Option<String>| {
        if !same {
            let reason = granted.refused.get(name).cloned();
            found.push(Difference { name: name.to_owned(), asked, set, reason });
        }
    };
    let letters = |fourcc: [u8; 4]| String::from_utf8_lossy(&fourcc).into_owned();
    let (wanted, set_fourcc) = (asked.format.fourcc(), granted.fourcc);
    note(wanted == set_fourcc, "format", letters(wanted), Some(letters(set_fourcc)));
    let same = (asked.width, asked.height) == (granted.width, granted.height);
    let set = format!("{}x{}", granted.width, granted.height);
    note(same, SIZE, format!("{}x{}", asked.width, asked.height), Some(set));
    // Rows that are longer are skipped; rows that are shorter hold no picture. Some drivers leave that to the reader.
    let tight = DriverFormat::of_fourcc(set_fourcc).and_then(|format| format.least_stride(granted.width)).unwrap_or(0);
    let stride = granted.stride as usize;
    note(stride == 0 || stride >= tight, STRIDE, format!("rows of {tight} bytes"), Some(stride.to_string()));
    let same = granted.rate_hz.is_some_and(|rate| (rate / asked.rate_hz - 1.0).abs() < RATE_TOLERANCE);
    note(same, "rate", format!("{} Hz", asked.rate_hz), granted.rate_hz.map(|rate| format!("{rate:.2} Hz")));
    for automatic in automatics(asked) {
        if let Some(&value) = granted.automatics.get(&automatic.name) {
            note(value == automatic.value, &automatic.name, automatic.value.to_string(), Some(value.to_string()));
        }
    }
    if let Some(wanted) = asked.exposure_us {
        let same = granted.exposure_us.is_some_and(|set| (set - wanted).abs() < EXPOSURE_STEP_US);
        note(same, "exposure", format!("{wanted} us"), granted.exposure_us.map(|set| format!("{set} us")));
    }
    let whole = [("gain", asked.gain, granted.gain), ("white_balance", asked.white_balance_k, granted.white_balance_k)];
    for (name, wanted, set) in whole {
        if let Some(wanted) = wanted {
            note(set == Some(wanted), name, wanted.to_string(), set.map(|set| set.to_string()));
        }
    }
    for (name, &wanted) in &asked.controls {
        let set = granted.controls.get(name).copied().flatten();
        note(set == Some(wanted), name, wanted.to_string(), set.map(|set| set.to_string()));
    }
    found
}

/// Parts what differs into what the configuration allows (first) and what it does not.
pub fn part(asked: &Config, found: Vec<Difference>) -> (Vec<Difference>, Vec<Difference>) {
    found.into_iter().partition(|difference| asked.may_differ.contains(&difference.name))
}

/// What `may_differ` could allow, as the end of a sentence; nothing where all of it must be as asked.
pub fn allowance(refused: &[Difference]) -> String {
    let names: Vec<String> =
        refused.iter().filter(|d| d.name != SIZE && d.name != STRIDE).map(|d| format!("{:?}", d.name)).collect();
    if names.is_empty() { String::new() } else { format!(", or add {} to may_differ", names.join(", ")) }
}
