//! Messages to bytes and back: the only file that names bincode.

use crate::{Header, Message};
use std::cmp::Ordering;

/// No message is larger; a decoder refuses lengths beyond it before it allocates.
pub const MAX_BYTES: usize = 1 << 29;

fn config() -> impl bincode::config::Config {
    bincode::config::standard().with_little_endian().with_limit::<MAX_BYTES>()
}

/// Why bytes are not the message that a reader expects.
#[derive(Debug, thiserror::Error)]
pub enum DecodeError {
    /// Not this message at all.
    #[error("{bytes} bytes are no {name}: {reason}")]
    Malformed {
        /// The expected message.
        name: &'static str,
        /// How many came.
        bytes: usize,
        /// What the decoder stumbled over.
        reason: String,
    },
    /// Something follows the message.
    #[error("{left} bytes follow a whole {name}")]
    Trailing {
        /// The expected message.
        name: &'static str,
        /// How many are left.
        left: usize,
    },
    /// The sender speaks another version.
    #[error("expected {expected}, got {got}: {advice}")]
    Schema {
        /// What this reader knows.
        expected: String,
        /// What came.
        got: String,
        /// Which of the two is to be updated.
        advice: &'static str,
    },
}

/// The bytes of a message.
///
/// # Panics
/// Never on data: encoding into memory cannot fail for plain structs.
#[allow(clippy::expect_used, reason = "a Vec grows; a plain struct has no fallible encoder")]
pub fn encode<M: Message>(message: &M) -> Vec<u8> {
    bincode::encode_to_vec(message, config()).expect("plain structs encode into memory")
}

/// The bytes of a message in two parts, of which the second is its [tail](Message::take_tail) as it lay in memory.
///
/// ```
/// # use wire::{Bulk, Frame, Header, Light, PixelFormat, codec};
/// # let (header, light) = (Header::default(), Light { laser: true, lamp: false });
/// # let (width, height, stride, format) = (20, 15, 20, PixelFormat::Grey8);
/// # let data = Bulk(vec![7; 300]);
/// # let frame = Frame { header, width, height, stride, format, light, exposure_nanos: 0, gain: 1.0, gamma: 1.0, data };
/// let (head, pixels) = codec::encode_apart(frame.clone());
/// assert_eq!(pixels, *frame.data);
/// assert_eq!([head, pixels].concat(), codec::encode(&frame));
/// ```
#[allow(clippy::expect_used, reason = "as in `encode`")]
pub fn encode_apart<M: Message>(mut message: M) -> (Vec<u8>, Vec<u8>) {
    let tail = message.take_tail();
    let mut head = encode(&message);
    if !tail.is_empty() {
        // The length of nothing is the one byte with which the head ends now.
        head.pop();
        head.extend(bincode::encode_to_vec(tail.len() as u64, config()).expect("a number encodes into memory"));
    }
    (head, tail)
}

/// A message from its bytes; all of them must be used.
pub fn decode<M: Message>(bytes: &[u8]) -> Result<M, DecodeError> {
    let malformed = |reason: String| DecodeError::Malformed { name: M::NAME, bytes: bytes.len(), reason };
    let (message, used) = bincode::decode_from_slice(bytes, config()).map_err(|e| malformed(format!("{e:?}")))?;
    match bytes.len() - used {
        0 => Ok(message),
        left => Err(DecodeError::Trailing { name: M::NAME, left }),
    }
}

/// The same from bytes that lie in pieces, as large messages come: they are copied once, to where they belong.
pub fn decode_pieces<M: Message>(pieces: impl std::io::Read, bytes: usize) -> Result<M, DecodeError> {
    let mut pieces = pieces.take(bytes as u64);
    let malformed = |reason: String| DecodeError::Malformed { name: M::NAME, bytes, reason };
    let message = bincode::decode_from_std_read(&mut pieces, config()).map_err(|e| malformed(format!("{e:?}")))?;
    match pieces.limit() {
        0 => Ok(message),
        left => Err(DecodeError::Trailing { name: M::NAME, left: left as usize }),
    }
}

/// The header with which every message begins, from the bytes of any of them.
pub fn header(bytes: &[u8]) -> Result<Header, DecodeError> {
    let read = bincode::decode_from_slice(bytes, config());
    let malformed = |e| DecodeError::Malformed { name: "message", bytes: bytes.len(), reason: format!("{e:?}") };
    read.map(|(header, _used)| header).map_err(malformed)
}

/// Name, version and layout of a message: `Frame@1:0123456789abcdef`.
pub fn schema<M: Message>() -> String {
    format!("{}@{}:{:016x}", M::NAME, M::VERSION, M::HASH)
}

/// Refuses what another version wrote, before anything is decoded.
pub fn check_schema<M: Message>(got: &str) -> Result<(), DecodeError> {
    let expected = schema::<M>();
    if got == expected {
        return Ok(());
    }
    let version = got.strip_prefix(M::NAME).and_then(|rest| rest.strip_prefix('@')?.split(':').next()?.parse().ok());
    let advice = match version.map(|version: u32| version.cmp(&M::VERSION)) {
        Some(Ordering::Greater) => "this node is the older one: update it",
        Some(Ordering::Less) => "the node that sends this is the older one: update it",
        Some(Ordering::Equal) => "sender and reader were built from different sources: update the older one",
        None => "who sends this is no node of limn, or sends on the wrong topic",
    };
    Err(DecodeError::Schema { expected, got: got.to_owned(), advice })
}

/// What a reader of all messages says of one that it does not know at all.
pub fn unknown(got: &str) -> DecodeError {
    let (expected, got) = ("a message of this limn".to_owned(), format!("{got:?}"));
    DecodeError::Schema { expected, got, advice: "another version wrote it, or somebody else" }
}
