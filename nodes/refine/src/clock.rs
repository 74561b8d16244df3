//! Stamps go forward, and a lone one that is far away is no stamp.

/// Why a stamp is not believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BadStamp {
    Backwards,
    Jump,
}

/// Looks at the stamps of one stream.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StampGuard {
    newest: Option<i64>,
    /// The last stamp that was far ahead.
    suspect: Option<i64>,
}

/// A single stamp so far ahead of the one before would shut out all that follow; two in a row are a pause.
const JUMP_NANOS: u64 = 60_000_000_000;

impl StampGuard {
    /// Takes a stamp that is later than all before.
    pub fn admit(&mut self, stamp_nanos: i64) -> Result<(), BadStamp> {
        if let Some(newest) = self.newest {
            if stamp_nanos <= newest {
                return Err(BadStamp::Backwards);
            }
            let follows = |suspect: i64| stamp_nanos > suspect && stamp_nanos.abs_diff(suspect) <= JUMP_NANOS;
            if stamp_nanos.abs_diff(newest) > JUMP_NANOS && !self.suspect.is_some_and(follows) {
                self.suspect = Some(stamp_nanos);
                return Err(BadStamp::Jump);
            }
        }
        self.suspect = None;
        self.newest = Some(stamp_nanos);
        Ok(())
    }
}
