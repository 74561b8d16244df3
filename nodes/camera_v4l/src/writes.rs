//! What is written into a camera, in which order.

use crate::config::Config;
use crate::exposure::Setting;
use std::collections::BTreeMap;

/// V4L2_CID_* of <linux/v4l2-controls.h>. A driver takes controls of one class (the upper half) in one call: each of these
/// is written by itself.
const EXPOSURE_AUTO: u32 = 0x009a_0901;
pub(crate) const EXPOSURE_ABSOLUTE: u32 = 0x009a_0902;
const EXPOSURE_SLOWS_RATE: u32 = 0x009a_0903;
const GAIN_AUTO: u32 = 0x0098_0912;
pub(crate) const GAIN: u32 = 0x0098_0913;
const WHITE_BALANCE_AUTO: u32 = 0x0098_090c;
pub(crate) const WHITE_BALANCE: u32 = 0x0098_091a;

/// V4L2_EXPOSURE_MANUAL.
const MANUAL: i64 = 1;
const OFF: i64 = 0;
/// EXPOSURE_ABSOLUTE counts in these.
pub(crate) const STEP_US: f64 = 100.0;

/// One control to be set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Write {
    /// As `may_differ` names it.
    pub name: String,
    /// V4L2's number.
    pub id: u32,
    /// The value.
    pub value: i64,
}

fn write(name: &str, id: u32, value: i64) -> Write {
    Write { name: name.to_owned(), id, value }
}

/// All that is configured, in its order; `ids` are the camera's own controls by name. What an automatic holds cannot be set
/// while it is on, and nobody says so: automatics go before what they hold.
pub fn writes(config: &Config, ids: &BTreeMap<String, u32>) -> Vec<Write> {
    let mut list = automatics(config);
    list.extend(config.exposure_us.map(|us| write("exposure", EXPOSURE_ABSOLUTE, steps(us))));
    list.extend(config.gain.map(|gain| write("gain", GAIN, gain)));
    list.extend(config.white_balance_k.map(|kelvin| write("white_balance", WHITE_BALANCE, kelvin)));
    let is_automatic = |name: &str| name.contains("auto");
    let (first, then): (Vec<_>, Vec<_>) = config.controls.iter().partition(|(name, _)| is_automatic(name));
    let named = first.into_iter().chain(then);
    list.extend(named.filter_map(|(name, &value)| Some(write(name, *ids.get(name)?, value))));
    list
}

/// The automatics that have to be off for what is configured. A camera need not have them.
pub fn automatics(config: &Config) -> Vec<Write> {
    let mut list = Vec::new();
    if config.exposure_us.is_some() {
        list.push(write("exposure_automatic", EXPOSURE_AUTO, MANUAL));
        list.push(write("exposure_slows_rate", EXPOSURE_SLOWS_RATE, OFF));
    }
    list.extend(config.gain.map(|_| write("gain_automatic", GAIN_AUTO, OFF)));
    list.extend(config.white_balance_k.map(|_| write("white_balance_automatic", WHITE_BALANCE_AUTO, OFF)));
    list
}

/// Exposure, and gain where its unit is known.
pub fn writes_of(config: &Config, wanted: Setting) -> Vec<Write> {
    let exposure = write("exposure", EXPOSURE_ABSOLUTE, steps(wanted.exposure_us));
    let gain = config.gain_unit.map(|unit| write("gain", GAIN, (wanted.gain * unit).round() as i64));
    std::iter::once(exposure).chain(gain).collect()
}

fn steps(us: f64) -> i64 {
    ((us / STEP_US).round() as i64).max(1)
}
