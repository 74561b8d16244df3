//! Messages as bytes, for whoever keeps or shows all of them.

use crate::ring::Ring;
use crate::subscriber::{Line, listen};
use crate::{BusError, publisher};
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};

/// A message as it travelled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RawMessage {
    /// Without the rig's namespace.
    pub key: String,
    /// Name, version and layout of what the bytes hold; empty when the sender did not say.
    pub schema: String,
    /// The bytes.
    pub bytes: Vec<u8>,
}

/// All messages whose keys match, oldest first.
pub struct RawSubscriber {
    #[allow(dead_code, reason = "held for its drop")]
    line: Line,
    ring: Ring,
}

pub(crate) fn declare(session: &Session, key_expression: &str, ring: Ring) -> Result<RawSubscriber, BusError> {
    Ok(RawSubscriber { line: listen(session, key_expression, true, &ring)?, ring })
}

pub(crate) fn forward(session: &Session, key: &str, schema: &str, bytes: Vec<u8>) -> Result<(), BusError> {
    session
        .put(key, bytes)
        .encoding(publisher::encoding(schema))
        .congestion_control(CongestionControl::Block)
        .wait()
        .map_err(BusError::zenoh(format!("forwarding {key}")))
}

impl RawSubscriber {
    /// The oldest message that waits.
    #[allow(clippy::should_implement_trait, reason = "a subscription never ends")]
    pub fn next(&mut self) -> Option<RawMessage> {
        let sample = self.ring.pop()?;
        let encoding = sample.encoding().to_string();
        let schema = encoding.split_once(';').map_or("", |(_, schema)| schema).to_owned();
        Some(RawMessage {
            key: sample.key_expr().as_str().to_owned(),
            schema,
            bytes: sample.payload().to_bytes().into_owned(),
        })
    }
}
