//! A setting that cannot be, of any node on a serial line.

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
}
