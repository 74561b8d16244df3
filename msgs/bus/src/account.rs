//! What came, what is missing and what came twice, by the numbers that the publisher counts.

use std::collections::BTreeMap;
use wire::Header;

/// A gap that is wider is none: no publisher sends so much (100 a second for three hours) while its reader sleeps.
const WIDEST_GAP: u64 = 1 << 20;

/// Keeps the account of one topic.
#[derive(Debug, Clone, Default)]
pub struct SequenceAccount {
    counting: BTreeMap<String, Counting>,
    newest: BTreeMap<String, (u64, u32, bool, i64)>,
    /// Messages that never came.
    pub lost: u64,
    /// Messages that came again after a restart of their publisher.
    pub repeated: u64,
}

/// How the numbers of one key go on.
#[derive(Debug, Clone, Copy)]
struct Counting {
    /// The number behind the last message.
    next: u64,
    /// The number behind one that did not follow on: a publisher that was born again counts from 0, and a stranger counts
    /// as he likes. The message behind it tells which of the two it was.
    elsewhere: Option<u64>,
}

impl Counting {
    /// Takes the next number and returns how many are missing before it.
    fn take(&mut self, seq: u64) -> u64 {
        let gap = |next: u64| seq.checked_sub(next).filter(|gap| *gap <= WIDEST_GAP);
        let (here, there) = (gap(self.next), self.elsewhere.and_then(gap));
        let behind = seq.saturating_add(1);
        let Some(missing) = here.into_iter().chain(there).min() else {
            self.elsewhere = Some(behind);
            return 0;
        };
        *self = Self { next: behind, elsewhere: None };
        missing
    }
}

impl SequenceAccount {
    /// Says which number comes first: whatever is missing before it is lost.
    pub fn expect(&mut self, key: &str, seq: u64) {
        self.counting.insert(key.to_owned(), Counting { next: seq, elsewhere: None });
    }

    /// Takes note of a message and returns how many are missing before it. A publisher that was restarted counts from
    /// 0 again, which is no loss; neither is a number that no publisher can have come to.
    ///
    /// ```
    /// # use bus::SequenceAccount;
    /// # use wire::Header;
    /// let mut account = SequenceAccount::default();
    /// let mut note = |seq| account.note("tracker/head/pose", &Header { seq, ..Header::default() });
    /// assert_eq!([100, 101, 104].map(&mut note), [0, 0, 2]);
    /// // A stranger, and it goes on as before.
    /// assert_eq!([u64::MAX, 105, 0, 106].map(&mut note), [0; 4]);
    /// // Born again.
    /// assert_eq!([0, 1, 3].map(&mut note), [0, 0, 1]);
    /// ```
    pub fn note(&mut self, key: &str, header: &Header) -> u64 {
        let Some(counting) = self.counting.get_mut(key) else {
            self.expect(key, header.seq.saturating_add(1));
            return 0;
        };
        let missing = counting.take(header.seq);
        self.lost = self.lost.saturating_add(missing);
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
