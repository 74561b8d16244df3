//! Sends the messages of one topic.

use crate::BusError;
use std::marker::PhantomData;
use wire::topic::{Class, Topic};
use wire::{Message, codec};
use zenoh::bytes::{Encoding, ZBytes};
use zenoh::pubsub;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::{Session, Wait};
use zenoh_ext::{AdvancedPublisher, AdvancedPublisherBuilderExt, CacheConfig, MissDetectionConfig};

/// How many messages of a stream its publisher keeps for a node that starts late (or again).
pub const STREAM_HISTORY: usize = 1 << 17;
/// How many pictures for colour: half a gigabyte at 1280x1024.
pub const GATHERED_HISTORY: usize = 128;

enum Line {
    Plain(pubsub::Publisher<'static>),
    Kept(AdvancedPublisher<'static>),
}

/// Sends the messages of one topic, each numbered one higher than the one before.
pub struct Publisher<M> {
    line: Line,
    key: String,
    next_seq: u64,
    message: PhantomData<fn(M)>,
}

pub(crate) fn encoding(schema: &str) -> Encoding {
    Encoding::from("application/x-bincode").with_schema(schema)
}

fn kept(builder: pubsub::PublisherBuilder<'_, 'static>, history: usize) -> zenoh::Result<Line> {
    builder
        .congestion_control(CongestionControl::Block)
        .cache(CacheConfig::default().max_samples(history))
        .sample_miss_detection(MissDetectionConfig::default())
        .publisher_detection()
        .wait()
        .map(Line::Kept)
}

pub(crate) fn declare<M: Message>(session: &Session, topic: &Topic<M>) -> Result<Publisher<M>, BusError> {
    let declaring = || BusError::zenoh(format!("publishing {}", topic.key));
    let builder = session.declare_publisher(topic.key.clone()).encoding(encoding(&codec::schema::<M>()));
    let line = match topic.class {
        Class::Frame => builder.congestion_control(CongestionControl::Block).wait().map(Line::Plain),
        Class::Trace => {
            builder.congestion_control(CongestionControl::Drop).priority(Priority::Background).wait().map(Line::Plain)
        }
        Class::Gathered => kept(builder, GATHERED_HISTORY),
        Class::Stream => kept(builder, STREAM_HISTORY),
        Class::Latched => kept(builder, 1),
    };
    Ok(Publisher { line: line.map_err(declaring())?, key: topic.key.clone(), next_seq: 0, message: PhantomData })
}

impl<M: Message> Publisher<M> {
    /// Numbers and sends a message.
    pub fn send(&mut self, mut message: M) -> Result<(), BusError> {
        message.header_mut().seq = self.next_seq;
        let (head, tail) = codec::encode_apart(message);
        let mut parts = ZBytes::writer();
        parts.append(head.into());
        parts.append(tail.into());
        let bytes = parts.finish();
        self.next_seq += 1;
        match &self.line {
            Line::Plain(publisher) => publisher.put(bytes).wait(),
            Line::Kept(publisher) => publisher.put(bytes).wait(),
        }
        .map_err(BusError::zenoh(format!("sending on {}", self.key)))
    }

    /// How many have been sent.
    pub fn sent(&self) -> u64 {
        self.next_seq
    }
}
