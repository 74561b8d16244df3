//! What is known of a camera.

use std::path::PathBuf;

/// A camera that is plugged in.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// The name for a launch file: one that stays the same, where there is one.
    pub path: PathBuf,
    /// The name that it has got this time.
    pub node: PathBuf,
    /// What it calls itself.
    pub name: String,
    /// What to do before this user may open it; none when it is open to him.
    pub missing: Option<String>,
    /// What it can do, or why that cannot be told.
    pub details: Result<Details, String>,
}

/// What a camera can do.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Details {
    /// The kernel's driver.
    pub driver: String,
    /// Formats, sizes and rates.
    pub modes: Vec<Mode>,
    /// What can be set.
    pub controls: Vec<Control>,
}

/// A format and a size.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// The four letters of the format.
    pub format: String,
    /// Of the picture.
    pub size: Size,
    /// Pictures a second, the most first; empty when it does not tell.
    pub rates_hz: Vec<f64>,
}

/// Pixels in a row, and rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// This one.
    Fixed(u32, u32),
    /// Anything between.
    Between {
        /// Smallest.
        least: (u32, u32),
        /// Largest.
        most: (u32, u32),
    },
}

/// Something that can be set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Control {
    /// The name for a launch file.
    pub key: String,
    /// Smallest.
    pub least: i64,
    /// Largest.
    pub most: i64,
    /// From one value to the next.
    pub step: u64,
    /// As the camera wakes up.
    pub default: i64,
    /// As it is now; none when it cannot be read.
    pub value: Option<i64>,
    /// What the values of a menu mean.
    pub items: Vec<(i64, String)>,
    /// Has no effect now, because an automatic holds it.
    pub inactive: bool,
}

/// The name of a control for a launch file, the same as v4l2-ctl has it: "White Balance, Automatic" is
/// `white_balance_automatic`.
///
/// ```
/// assert_eq!(devices::control_key("White Balance, Automatic"), "white_balance_automatic");
/// ```
pub fn control_key(name: &str) -> String {
    let mut key = String::with_capacity(name.len());
    for c in name.chars() {
        if c.is_alphanumeric() {
            key.extend(c.to_lowercase());
        } else if !key.is_empty() && !key.ends_with('_') {
            key.push('_');
        }
    }
    key.trim_end_matches('_').to_owned()
}
