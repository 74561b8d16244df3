//! What a device is told, one thing after the other.

use std::time::Duration;

/// Bytes to send, and how long to wait behind them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// What it does.
    pub about: &'static str,
    /// The bytes; none for a mere wait.
    pub send: Vec<u8>,
    /// The wait.
    pub wait: Duration,
}
