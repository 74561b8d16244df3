//! One message as it was recorded.

use wire::codec::{self, DecodeError};

/// Key, schema and bytes, as they travelled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// The topic, without the rig's namespace.
    pub key: String,
    /// Name, version and layout of what the bytes hold.
    pub schema: String,
    /// The moment of measuring; 0 for moments before zero, when it comes from a recording.
    pub stamp_nanos: i64,
    /// The message.
    pub bytes: Vec<u8>,
}

impl Message {
    /// The message itself; refuses one that another version wrote, naming both.
    pub fn decode<M: wire::Message>(&self) -> Result<M, DecodeError> {
        codec::check_schema::<M>(&self.schema)?;
        codec::decode(&self.bytes)
    }

    pub(crate) fn encode<M: wire::Message>(key: &str, message: &M) -> Self {
        Self {
            key: key.to_owned(),
            schema: codec::schema::<M>(),
            stamp_nanos: message.header().stamp_nanos,
            bytes: codec::encode(message),
        }
    }
}
