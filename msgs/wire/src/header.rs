//! What every message begins with.

use crate::layout::{layout, message};

layout! {
    /// Which clock a stamp was read from.
    pub enum Clock {
        /// The system clock of the capturing machine, since the epoch.
        System,
        /// The clock of a simulated or replayed world, since the start of its scan.
        Scan,
    }
}

layout! {
    /// What the operator is doing.
    pub enum Phase {
        /// Aiming: nothing is kept.
        Aim,
        /// Laser only: shape is gathered.
        Shape,
        /// Lamp only: colour is gathered.
        Colour,
        /// Laser and lamp in turn: both in one pass.
        Both,
        /// Travels in each stream behind its last message: nothing follows in this scan.
        End,
    }
}

layout! {
    /// Where a message stands: in which scan, when it was measured, and how many came before it.
    #[derive(Copy, Eq)]
    pub struct Header {
        /// Counts the scans of a rig; a new number starts afresh.
        pub scan: u64,
        /// The phase that the source was in.
        pub phase: Phase,
        /// 0 is live; a refinement sends the scan, or what changed of it, again under a higher number.
        pub revision: u32,
        /// Counted by the publisher of this topic, from 0. A gap is a loss.
        pub seq: u64,
        /// The moment of measuring (middle of exposure; the tracker's sample), copied into all that is computed from it.
        pub stamp_nanos: i64,
        /// The clock of the stamp.
        pub clock: Clock,
    }
}

impl Default for Header {
    fn default() -> Self {
        Self { scan: 0, phase: Phase::Aim, revision: 0, seq: 0, stamp_nanos: 0, clock: Clock::Scan }
    }
}

impl Header {
    /// The header of a result: same scan, phase, revision, stamp and clock; the publisher counts anew.
    pub fn derived(&self) -> Self {
        Self { seq: 0, ..*self }
    }

    /// True for the message behind the last one.
    pub fn is_end(&self) -> bool {
        self.phase == Phase::End
    }
}

layout! {
    /// How many items were refused for one reason.
    pub struct Refusal {
        /// Why, in a few words of the node that refused.
        pub reason: String,
        /// How many, since the message before.
        pub count: u64,
    }
}

layout! {
    /// The phase that the operator chose; latched, so that a source that starts late knows it.
    pub struct RunPhase {
        /// `phase` in here is the message.
        pub header: Header,
        /// Throw away what this scan has gathered.
        pub discard: bool,
    }
}
message!(RunPhase @ 1);
