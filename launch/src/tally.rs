//! How often messages come on each key, how large they are, and how many are missing.

use crate::decode;
use bus::{RawMessage, SequenceAccount};
use std::collections::BTreeMap;

/// What came on one key.
#[derive(Debug, Clone, Default)]
pub struct Tally {
    /// Name and version of the latest message.
    pub schema: String,
    /// Messages.
    pub messages: u64,
    /// Their size.
    pub bytes: u64,
    /// Gaps in their numbers.
    pub lost: u64,
    /// Messages that this program cannot read.
    pub unreadable: u64,
    account: SequenceAccount,
}

/// What came on every key.
#[derive(Debug, Clone, Default)]
pub struct Tallies(pub BTreeMap<String, Tally>);

impl Tallies {
    /// Counts a message.
    pub fn note(&mut self, message: &RawMessage) {
        let tally = self.0.entry(message.key.clone()).or_default();
        tally.schema.clone_from(&message.schema);
        tally.messages += 1;
        tally.bytes += message.bytes.len() as u64;
        match decode::header(&message.schema, &message.bytes) {
            Ok(header) => {
                tally.account.note(&message.key, &header);
                tally.lost = tally.account.lost;
            }
            Err(_) => tally.unreadable += 1,
        }
    }
}
