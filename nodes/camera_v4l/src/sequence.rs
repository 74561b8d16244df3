//! Frames that never came, by the numbers that the driver gives them.

/// What a number says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// The next one, after so many that were lost.
    New {
        /// Between this one and the one before.
        lost: u32,
    },
    /// The same number again.
    Repeated,
    /// The driver counts anew.
    Restarted,
}

/// The account of a driver's numbers, over any number of streams.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SequenceCount {
    last: Option<u32>,
    /// Frames that never came.
    pub lost: u64,
    /// Frames that came under the number of the one before.
    pub repeated: u64,
}

impl SequenceCount {
    /// Takes the next number; the numbers wrap.
    pub fn note(&mut self, sequence: u32) -> Step {
        let step = match self.last.map(|last| sequence.wrapping_sub(last)) {
            None => Step::New { lost: 0 },
            Some(0) => Step::Repeated,
            Some(ahead @ 1..=0x7FFF_FFFF) => Step::New { lost: ahead - 1 },
            Some(_) => Step::Restarted,
        };
        self.last = Some(sequence);
        match step {
            Step::New { lost } => self.lost += u64::from(lost),
            Step::Repeated => self.repeated += 1,
            Step::Restarted => {}
        }
        step
    }

    /// A new stream: its first number follows nothing.
    pub fn restart(&mut self) {
        self.last = None;
    }
}
