//! Inputs and outputs of a node, with their accounts.

use bus::{BusError, InputCounts, Publisher, RawMessage, RawSubscriber, Subscriber};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use wire::{Frame, Message};

/// The account of one input, as the node's health reports it.
pub(crate) type SharedCounts = Arc<Mutex<InputCounts>>;

/// Messages of one topic, oldest first.
pub struct Input<M> {
    subscriber: Subscriber<M>,
    counts: SharedCounts,
}

impl<M: Message> Input<M> {
    pub(crate) fn new(subscriber: Subscriber<M>) -> Self {
        Self { subscriber, counts: SharedCounts::default() }
    }

    pub(crate) fn counts(&self) -> SharedCounts {
        self.counts.clone()
    }

    /// The oldest message that waits.
    #[allow(clippy::should_implement_trait, reason = "an input never ends")]
    pub fn next(&mut self) -> Option<M> {
        let message = self.subscriber.next();
        let counts = self.subscriber.counts();
        let mut shared = self.counts.lock().unwrap_or_else(PoisonError::into_inner);
        if *shared != *counts {
            shared.clone_from(counts);
        }
        message
    }

    /// The newest message that waits; older ones are let go.
    pub fn newest(&mut self) -> Option<M> {
        let mut newest = None;
        while let Some(message) = self.next() {
            newest = Some(message);
        }
        newest
    }
}

/// Messages of all topics whose keys match, as they travelled, oldest first.
pub struct RawInput {
    subscriber: RawSubscriber,
    counts: SharedCounts,
}

impl RawInput {
    pub(crate) fn new(subscriber: RawSubscriber) -> Self {
        Self { subscriber, counts: SharedCounts::default() }
    }

    pub(crate) fn counts(&self) -> SharedCounts {
        self.counts.clone()
    }

    /// The oldest message that waits.
    #[allow(clippy::should_implement_trait, reason = "an input never ends")]
    pub fn next(&mut self) -> Option<RawMessage> {
        let message = self.subscriber.next()?;
        let counts = self.subscriber.counts();
        let mut shared = self.counts.lock().unwrap_or_else(PoisonError::into_inner);
        if counts.lost > shared.lost {
            tracing::error!("{}: {} messages lost", message.key, counts.lost - shared.lost);
        }
        shared.clone_from(counts);
        Some(message)
    }
}

/// Sends the messages of one topic.
pub struct Output<M> {
    publisher: Publisher<M>,
    sent: Arc<AtomicU64>,
}

impl<M: Message> Output<M> {
    pub(crate) fn new(publisher: Publisher<M>, sent: Arc<AtomicU64>) -> Self {
        Self { publisher, sent }
    }

    /// Numbers and sends a message.
    pub fn send(&mut self, message: M) -> Result<(), BusError> {
        self.publisher.send(message)?;
        self.sent.fetch_add(1, Ordering::Relaxed);
        Ok(())
    }
}

/// Sends the pictures of one camera.
pub struct Pictures {
    pub(crate) frames: Output<Frame>,
    pub(crate) colours: Output<Frame>,
}

impl Pictures {
    /// Sends a picture where it belongs ([`Frame::by_topic`]).
    pub fn send(&mut self, picture: Frame) -> Result<(), BusError> {
        let (frame, colour) = picture.by_topic();
        self.frames.send(frame)?;
        colour.map_or(Ok(()), |colour| self.colours.send(colour))
    }
}
