//! What of a recording could not be used: passed over, counted, and told at the end.

use replay::Message;
use std::collections::BTreeMap;
use std::fmt::Display;

/// How often each reason came up.
#[derive(Debug, Default)]
pub(crate) struct Skipped(BTreeMap<String, u64>);

impl Skipped {
    /// What there is; or nothing, and its reason is counted.
    pub(crate) fn unless_bad<T, E: Display>(&mut self, what: Result<T, E>) -> Option<T> {
        what.map_err(|error| *self.0.entry(error.to_string()).or_default() += 1).ok()
    }

    /// The message itself; or nothing, and what is wrong with it is counted.
    pub(crate) fn read<M: wire::Message>(&mut self, message: &Message) -> Option<M> {
        self.unless_bad(message.decode().map_err(|error| format!("{}: {error}", message.key)))
    }

    /// One warning for each reason.
    pub(crate) fn tell(&self) {
        for (reason, count) in &self.0 {
            tracing::warn!("left out, {count} x {reason}");
        }
    }
}
