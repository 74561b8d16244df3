//! What the operator is doing: the phases of a rig's scans, in order.

use wire::{Clock, Header, Phase, RunPhase};

/// What an operator may ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Order {
    /// Gather shape, by the laser.
    Shape,
    /// Gather colour, by the lamp.
    Colour,
    /// Gather both in one pass.
    Both,
    /// The scan is complete: make the model.
    End,
    /// Throw away what this scan has gathered.
    Discard,
}

impl Order {
    /// As it travels to the launcher.
    pub fn to_wire(self) -> RunPhase {
        let phase = match self {
            Self::Shape => Phase::Shape,
            Self::Colour => Phase::Colour,
            Self::Both => Phase::Both,
            Self::End => Phase::End,
            Self::Discard => Phase::Aim,
        };
        RunPhase { header: Header { phase, ..Header::default() }, discard: self == Self::Discard }
    }

    /// The order by which a rig begins in a phase; aiming needs none.
    pub fn beginning(phase: Phase) -> Option<Self> {
        match phase {
            Phase::Shape => Some(Self::Shape),
            Phase::Colour => Some(Self::Colour),
            Phase::Both => Some(Self::Both),
            Phase::Aim | Phase::End => None,
        }
    }

    /// As it came; aiming is how a scan starts, nobody asks for it but by discarding.
    pub fn from_wire(order: &RunPhase) -> Self {
        match order.header.phase {
            _ if order.discard => Self::Discard,
            Phase::Shape => Self::Shape,
            Phase::Colour => Self::Colour,
            Phase::Both => Self::Both,
            Phase::End => Self::End,
            Phase::Aim => Self::Discard,
        }
    }
}

/// True for the phases in which something is gathered.
pub fn is_scanning(phase: Phase) -> bool {
    !matches!(phase, Phase::Aim | Phase::End)
}

/// Follows the orders. The first scan is number 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Operator {
    /// The number of the scan.
    pub scan: u64,
    /// What is going on.
    pub phase: Phase,
    epoch_nanos: i64,
}

impl Default for Operator {
    fn default() -> Self {
        Self { scan: 1, phase: Phase::Aim, epoch_nanos: 0 }
    }
}

impl Operator {
    /// True between the first order and the end of a scan.
    pub fn is_scanning(&self) -> bool {
        is_scanning(self.phase)
    }

    /// What to publish now, on an order that came at `now_nanos` of the system clock; `None` when it changes nothing.
    ///
    /// The stamp of a phase is the moment when its scan began: 0 on the scan's own clock.
    pub fn obey(&mut self, order: Order, now_nanos: i64) -> Option<RunPhase> {
        let was = *self;
        match order {
            Order::Shape | Order::Colour | Order::Both => {
                if self.phase == Phase::End {
                    self.scan += 1;
                }
                if !self.is_scanning() {
                    self.epoch_nanos = now_nanos;
                }
                self.phase = order.to_wire().header.phase;
            }
            Order::End if self.is_scanning() => self.phase = Phase::End,
            Order::End => return None,
            // What was gathered belongs to the old number; a new one starts afresh.
            Order::Discard => {
                self.scan += 1;
                self.phase = Phase::Aim;
            }
        }
        (*self != was).then(|| RunPhase { discard: order == Order::Discard, ..self.to_wire() })
    }

    /// As it is published.
    pub fn to_wire(&self) -> RunPhase {
        let clock = Clock::System;
        let header =
            Header { scan: self.scan, phase: self.phase, stamp_nanos: self.epoch_nanos, clock, ..Header::default() };
        RunPhase { header, discard: false }
    }
}
