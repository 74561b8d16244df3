//! What came, what is missing and what came twice, by the numbers that the publisher counts.

use std::collections::BTreeMap;
use wire::Header;

/// Keeps the account of one topic.
#[derive(Debug, Clone, Default)]
pub struct SequenceAccount {
    expected: BTreeMap<String, u64>,
    newest: BTreeMap<String, (u64, u32, bool, i64)>,
    /// Messages that never came.
    pub lost: u64,
    /// Messages that came again after a restart of their publisher.
    pub repeated: u64,
}

impl SequenceAccount {
    /// Says which number comes first: whatever is missing before it is lost.
    pub fn expect(&mut self, key: &str, seq: u64) {
        self.expected.insert(key.to_owned(), seq);
    }

    /// Takes note of a message and returns how many are missing before it. A publisher that was restarted counts from
    /// 0 again, which is no loss.
    pub fn note(&mut self, key: &str, header: &Header) -> u64 {
        let Some(expected) = self.expected.get_mut(key) else {
            self.expected.insert(key.to_owned(), header.seq + 1);
            return 0;
        };
        let missing = header.seq.saturating_sub(*expected);
        *expected = header.seq + 1;
        self.lost += missing;
        missing
    }

    /// True when a message is later than all before it on its key; one that is not came again, and is counted.
    pub fn is_fresh(&mut self, key: &str, header: &Header) -> bool {
        let place = (header.scan, header.revision, header.is_end(), header.stamp_nanos);
        match self.newest.get_mut(key) {
            Some(newest) if place <= *newest => {
                self.repeated += 1;
                false
            }
            Some(newest) => {
                *newest = place;
                true
            }
            None => {
                self.newest.insert(key.to_owned(), place);
                true
            }
        }
    }
}
