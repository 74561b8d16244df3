//! Receives the messages of one topic.

use crate::ring::Ring;
use crate::{BusError, SequenceAccount};
use std::marker::PhantomData;
use std::time::Duration;
use wire::topic::{Class, Topic};
use wire::{Message, codec};
use zenoh::sample::Sample;
use zenoh::{Session, Wait, pubsub};
use zenoh_ext::{AdvancedSubscriber, AdvancedSubscriberBuilderExt, HistoryConfig, RecoveryConfig};

pub(crate) enum Line {
    Plain(#[allow(dead_code, reason = "held for its drop")] pubsub::Subscriber<()>),
    WithHistory(#[allow(dead_code, reason = "held for its drop")] AdvancedSubscriber<()>),
}

/// What a line gets besides what is sent from now on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Past {
    /// Nothing.
    None,
    /// What its publishers keep.
    Kept,
    /// That, and again what was dropped on the way.
    Recovered,
}

/// How often one who looks on asks for what was dropped.
const RECOVER_EVERY: Duration = Duration::from_secs(1);

pub(crate) fn listen(session: &Session, key: &str, past: Past, ring: &Ring) -> Result<Line, BusError> {
    let (ring, depth) = (ring.clone(), ring.depth());
    let builder = session.declare_subscriber(key.to_owned()).callback(move |sample| ring.push(sample));
    // More than the ring holds would only fall out of it. Publishers that come later need no question of their own: the
    // router passes on all they send. With such a second question (`detect_late_publishers`) zenoh-ext 1.10.2 forgets a
    // stream's history when something new comes between the two answers.
    let history = HistoryConfig::default().max_samples(depth);
    match past {
        Past::None => builder.wait().map(Line::Plain),
        Past::Kept => builder.history(history).wait().map(Line::WithHistory),
        Past::Recovered => {
            let recovery = RecoveryConfig::default().periodic_queries(RECOVER_EVERY);
            builder.history(history).recovery(recovery).wait().map(Line::WithHistory)
        }
    }
    .map_err(BusError::zenoh(format!("subscribing to {key}")))
}

/// What one input has seen.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct InputCounts {
    /// Messages handed to the node.
    pub received: u64,
    /// Gaps in the numbers.
    pub lost: u64,
    /// Messages that came again after a restart of their publisher.
    pub repeated: u64,
    /// Messages that could not be read.
    pub refused: u64,
    /// The latest reason of a refusal.
    pub reason: Option<String>,
}

impl InputCounts {
    /// Counts a message that cannot be read. The reason is logged once; the count tells how often.
    pub(crate) fn refuse(&mut self, key: &str, error: &codec::DecodeError) {
        self.refused += 1;
        let reason = error.to_string();
        if self.reason.as_ref() != Some(&reason) {
            tracing::error!("{key}: refused a message: {reason}");
            self.reason = Some(reason);
        }
    }
}

/// The messages of one topic, oldest first.
pub struct Subscriber<M> {
    #[allow(dead_code, reason = "held for its drop")]
    line: Line,
    ring: Ring,
    key: String,
    fresh_only: bool,
    counts_gaps: bool,
    account: SequenceAccount,
    counts: InputCounts,
    message: PhantomData<fn() -> M>,
}

pub(crate) fn declare<M: Message>(
    session: &Session,
    topic: &Topic<M>,
    onlooker: bool,
    ring: Ring,
) -> Result<Subscriber<M>, BusError> {
    let past = match topic.class {
        Class::Frame | Class::Trace => Past::None,
        // Of a stream the newest alone is wanted: what was dropped is not missed.
        Class::Stream if ring.depth() == 1 => Past::Kept,
        Class::Stream | Class::Latched if onlooker => Past::Recovered,
        Class::Gathered | Class::Stream | Class::Latched => Past::Kept,
    };
    Ok(Subscriber {
        line: listen(session, &topic.key, past, &ring)?,
        ring,
        key: topic.key.clone(),
        fresh_only: false,
        // What is dropped first is no loss.
        counts_gaps: topic.class != Class::Trace,
        account: SequenceAccount::default(),
        counts: InputCounts::default(),
        message: PhantomData,
    })
}

impl<M: Message> Subscriber<M> {
    /// Hands on only messages later than all before (by scan, revision and stamp): a restarted publisher sends its
    /// history again.
    pub fn fresh_only(mut self) -> Self {
        self.fresh_only = true;
        self
    }

    /// For a node that is started again: messages before this number are done with, those from it on that do not come are
    /// lost.
    pub fn expecting(mut self, seq: u64) -> Self {
        self.account.expect(&self.key, seq);
        self
    }

    /// For whoever looks now and then and takes what is newest: what it lets go is no loss.
    pub fn glimpses(mut self) -> Self {
        self.counts_gaps = false;
        self
    }

    /// The oldest message that waits. What cannot be read is counted, logged and skipped.
    #[allow(clippy::should_implement_trait, reason = "a subscription never ends")]
    pub fn next(&mut self) -> Option<M> {
        while let Some(sample) = self.ring.pop() {
            match self.read(&sample) {
                Ok(Some(message)) => {
                    self.counts.received += 1;
                    return Some(message);
                }
                Ok(None) => {}
                Err(error) => self.counts.refuse(sample.key_expr().as_str(), &error),
            }
        }
        None
    }

    /// The newest message that waits; older ones are let go without being counted as lost.
    pub fn newest(&mut self) -> Option<M> {
        let mut newest = None;
        while let Some(message) = self.next() {
            newest = Some(message);
        }
        newest
    }

    fn read(&mut self, sample: &Sample) -> Result<Option<M>, codec::DecodeError> {
        let encoding = sample.encoding().to_string();
        codec::check_schema::<M>(encoding.split_once(';').map_or("", |(_, schema)| schema))?;
        let payload = sample.payload();
        let message: M = match payload.slices().count() {
            0 | 1 => codec::decode(&payload.to_bytes())?,
            _ => codec::decode_pieces(payload.reader(), payload.len())?,
        };
        let key = sample.key_expr().as_str();
        if self.fresh_only && !self.account.is_fresh(key, message.header()) {
            self.counts.repeated = self.account.repeated;
            self.account.note(key, message.header());
            return Ok(None);
        }
        let missing = if self.counts_gaps { self.account.note(key, message.header()) } else { 0 };
        if missing > 0 {
            self.counts.lost = self.account.lost;
            tracing::error!("{key}: {missing} messages lost before number {}", message.header().seq);
        }
        Ok(Some(message))
    }

    /// The key, as it was subscribed.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// What this input has seen.
    pub fn counts(&self) -> &InputCounts {
        &self.counts
    }
}
