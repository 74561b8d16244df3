//! A setting that cannot be, of any node on a serial line.

use std::path::Path;

/// A setting that cannot be.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{node}: {key} = {value}: {wanted}")]
pub struct ConfigError {
    /// Whose.
    pub node: &'static str,
    /// The key.
    pub key: &'static str,
    /// What it holds.
    pub value: String,
    /// What it should hold.
    pub wanted: &'static str,
}

impl ConfigError {
    /// Refuses a number outside of its range; no range holds NaN.
    ///
    /// # Errors
    /// Such a number.
    pub fn unless_within(
        node: &'static str,
        (key, value, least, most, wanted): (&'static str, f64, f64, f64, &'static str),
    ) -> Result<(), Self> {
        if value >= least && value <= most {
            return Ok(());
        }
        Err(Self { node, key, value: value.to_string(), wanted })
    }
    /// Refuses a line that cannot be opened: a port without a name, or a rate that the device does not have.
    ///
    /// # Errors
    /// Such a line.
    pub fn unless_line(
        node: &'static str,
        port: &Path,
        (baud, has, wanted): (u32, impl Fn(u32) -> bool, &'static str),
    ) -> Result<(), Self> {
        if port.as_os_str().is_empty() {
            let wanted = "name the serial port; `limn devices` lists them";
            return Err(Self { node, key: "port", value: "\"\"".to_owned(), wanted });
        }
        if has(baud) {
            return Ok(());
        }
        Err(Self { node, key: "baud", value: baud.to_string(), wanted })
    }
}
