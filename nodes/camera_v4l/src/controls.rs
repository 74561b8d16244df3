//! The controls of a camera: written, and read back.

use crate::config::Config;
use crate::exposure::Setting;
use crate::granted::Granted;
use crate::trouble::Trouble;
use crate::v4l_device::calmly;
use crate::writes::{EXPOSURE_ABSOLUTE, GAIN, STEP_US, Write, automatics, writes, writes_of};
use devices::control_key;
use std::collections::BTreeMap;
use std::io;
use v4l::control::{Control, Description, Value};

/// The controls of a camera by the names that launch files use.
pub(crate) struct Controls(BTreeMap<String, u32>);

impl Controls {
    /// None for a camera without any, or one whose list the crate cannot read.
    pub(crate) fn of(device: &v4l::Device) -> Self {
        let list = calmly(|| device.query_controls()).unwrap_or_default();
        Self(list.iter().map(|control: &Description| (control_key(&control.name), control.id)).collect())
    }

    /// Sets all that is configured; what the driver says to those of its controls that it does not set.
    pub(crate) fn apply(&self, config: &Config, device: &v4l::Device) -> BTreeMap<String, String> {
        let list = writes(config, &self.0);
        let refused = list.into_iter().filter_map(|write| Some((carry_out(device, &write).err()?, write)));
        // Another camera has not got it: that shows where it is read back.
        let own = refused.filter(|(_, write)| self.0.values().any(|id| *id == write.id));
        own.map(|(error, write)| (write.name, error.to_string())).collect()
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

/// What the automatics are that should be off; those that the camera has.
pub(crate) fn automatic_values(config: &Config, device: &v4l::Device) -> BTreeMap<String, i64> {
    automatics(config).into_iter().filter_map(|write| Some((write.name, read(device, write.id)?))).collect()
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

/// Whether it took effect is told by reading it back as well: what is out of range, or held by an automatic, is no error.
fn carry_out(device: &v4l::Device, write: &Write) -> io::Result<()> {
    calmly(|| device.set_control(Control { id: write.id, value: Value::Integer(write.value) }))
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
pub(crate) fn set(config: &Config, device: &v4l::Device, wanted: Setting, before: Setting) -> Result<Setting, Trouble> {
    for write in writes_of(config, wanted) {
        carry_out(device, &write)
            .map_err(|error| Trouble::opening(&config.device, "setting exposure and gain", &error))?;
    }
    let exposure_us = exposure_us(device).unwrap_or(before.exposure_us);
    let Some(unit) = config.gain_unit else { return Ok(Setting { exposure_us, ..before }) };
    let gain = read(device, GAIN).map_or(before.gain, |gain| gain as f64 / unit);
    Ok(Setting { exposure_us, gain })
}
