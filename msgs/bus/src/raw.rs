//! Messages as bytes, for whoever keeps or shows all of them.

use crate::ring::Ring;
use crate::subscriber::{Line, Past, listen};
use crate::{BusError, InputCounts, SequenceAccount, publisher};
use wire::codec::{self, DecodeError};
use wire::{Header, Message};
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
    /// Where it stands; `None` when this version cannot read it.
    pub header: Option<Header>,
}

/// Of larger messages (pictures, models) the header alone is read: to look through all of them would cost a copy of each.
const READ_WHOLE: usize = 1 << 16;

/// All messages whose keys match, oldest first.
pub struct RawSubscriber {
    #[allow(dead_code, reason = "held for its drop")]
    line: Line,
    ring: Ring,
    account: SequenceAccount,
    counts: InputCounts,
}

pub(crate) fn declare(session: &Session, key_expression: &str, ring: Ring) -> Result<RawSubscriber, BusError> {
    let line = listen(session, key_expression, Past::Kept, &ring)?;
    Ok(RawSubscriber { line, ring, account: SequenceAccount::default(), counts: InputCounts::default() })
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
        let (key, bytes) = (sample.key_expr().as_str().to_owned(), sample.payload().to_bytes().into_owned());
        self.counts.received += 1;
        let header = self.note(&key, &schema, &bytes);
        Some(RawMessage { key, schema, bytes, header })
    }

    fn note(&mut self, key: &str, schema: &str, bytes: &[u8]) -> Option<Header> {
        match header(schema, bytes) {
            Ok(header) => {
                self.account.note(key, &header);
                self.counts.lost = self.account.lost;
                Some(header)
            }
            Err(error) => {
                self.counts.refuse(key, &error);
                None
            }
        }
    }

    /// What has come, and what is missing in it.
    pub fn counts(&self) -> &InputCounts {
        &self.counts
    }
}

/// The header of what this version can read; what only begins like a message is none.
fn header(schema: &str, bytes: &[u8]) -> Result<Header, DecodeError> {
    macro_rules! any {
        ($($message:ty),*) => {
            match schema.split('@').next().unwrap_or("") {
                $(<$message as Message>::NAME => header_of::<$message>(schema, bytes),)*
                _ => Err(codec::unknown(schema)),
            }
        };
    }
    wire::for_all_messages!(any)
}

fn header_of<M: Message>(schema: &str, bytes: &[u8]) -> Result<Header, DecodeError> {
    codec::check_schema::<M>(schema)?;
    if bytes.len() > READ_WHOLE { codec::header(bytes) } else { Ok(*codec::decode::<M>(bytes)?.header()) }
}
