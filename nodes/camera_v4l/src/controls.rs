//! What can be set on a camera, by number and by name.

use crate::config::Config;
use crate::exposure::Setting;
use crate::granted::Granted;
use crate::v4l_device::calmly;
use devices::control_key;
use std::collections::BTreeMap;
use v4l::control::{Control, Description, Value};

/// V4L2_CID_* of <linux/v4l2-controls.h>.
const EXPOSURE_AUTO: u32 = 0x009a_0901;
const EXPOSURE_ABSOLUTE: u32 = 0x009a_0902;
const EXPOSURE_SLOWS_RATE: u32 = 0x009a_0903;
const GAIN_AUTO: u32 = 0x0098_0912;
pub(crate) const GAIN: u32 = 0x0098_0913;
const WHITE_BALANCE_AUTO: u32 = 0x0098_090c;
pub(crate) const WHITE_BALANCE: u32 = 0x0098_091a;

/// V4L2_EXPOSURE_MANUAL.
const MANUAL: i64 = 1;
const OFF: i64 = 0;
/// EXPOSURE_ABSOLUTE counts in these.
const STEP_US: f64 = 100.0;

/// The controls of a camera by the names that launch files use.
pub(crate) struct Controls(BTreeMap<String, u32>);

impl Controls {
    /// None for a camera without any, or one whose list the crate cannot read.
    pub(crate) fn of(device: &v4l::Device) -> Self {
        let list = calmly(|| device.query_controls()).unwrap_or_default();
        Self(list.iter().map(|control: &Description| (control_key(&control.name), control.id)).collect())
    }

    /// What these are now.
    pub(crate) fn values<'a>(
        &self,
        device: &v4l::Device,
        names: impl Iterator<Item = &'a String>,
    ) -> BTreeMap<String, Option<i64>> {
        names.map(|name| (name.clone(), self.0.get(name).and_then(|id| read(device, *id)))).collect()
    }
}

/// A control now; none when there is none, or it is no number.
pub(crate) fn read(device: &v4l::Device, id: u32) -> Option<i64> {
    match calmly(|| device.control(id)).ok()?.value {
        Value::Integer(value) => Some(value),
        Value::Boolean(value) => Some(i64::from(value)),
        _ => None,
    }
}

pub(crate) fn exposure_us(device: &v4l::Device) -> Option<f64> {
    read(device, EXPOSURE_ABSOLUTE).map(|steps| steps as f64 * STEP_US)
}

/// Whether it took effect is told by reading it back. One at a time: two classes in one call are refused.
fn write(device: &v4l::Device, id: u32, value: i64) {
    let _ = calmly(|| device.set_control(Control { id, value: Value::Integer(value) }));
}

/// Sets all that is configured. Automatics go first: while they are on, what they hold cannot be set, and nobody says so.
pub(crate) fn apply(config: &Config, device: &v4l::Device, controls: &Controls) {
    if let Some(us) = config.exposure_us {
        write(device, EXPOSURE_AUTO, MANUAL);
        write(device, EXPOSURE_SLOWS_RATE, OFF);
        write(device, EXPOSURE_ABSOLUTE, steps(us));
    }
    if let Some(gain) = config.gain {
        write(device, GAIN_AUTO, OFF);
        write(device, GAIN, gain);
    }
    if let Some(kelvin) = config.white_balance_k {
        write(device, WHITE_BALANCE_AUTO, OFF);
        write(device, WHITE_BALANCE, kelvin);
    }
    for (name, &value) in &config.controls {
        if let Some(id) = controls.0.get(name) {
            write(device, *id, value);
        }
    }
}

fn steps(us: f64) -> i64 {
    ((us / STEP_US).round() as i64).max(1)
}

/// Exposure and gain as pictures carry them.
pub(crate) fn setting(config: &Config, granted: &Granted) -> Setting {
    let gain = match (config.gain_unit, granted.gain) {
        (Some(unit), Some(gain)) => gain as f64 / unit,
        _ => 1.0,
    };
    Setting { exposure_us: granted.exposure_us.or(config.exposure_us).unwrap_or(0.0), gain }
}

/// Sets exposure, and gain where its unit is known; what they are then.
pub(crate) fn set(config: &Config, device: &v4l::Device, wanted: Setting, before: Setting) -> Setting {
    write(device, EXPOSURE_ABSOLUTE, steps(wanted.exposure_us));
    let exposure_us = exposure_us(device).unwrap_or(before.exposure_us);
    let Some(unit) = config.gain_unit else { return Setting { exposure_us, ..before } };
    write(device, GAIN, (wanted.gain * unit).round() as i64);
    let gain = read(device, GAIN).map_or(before.gain, |gain| gain as f64 / unit);
    Setting { exposure_us, gain }
}
