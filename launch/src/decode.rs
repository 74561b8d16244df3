//! Bytes of any known message, for people to read.

use wire::{Header, Message, codec};

/// The text of a message, by the name in its schema; long lists are cut.
pub fn text(schema: &str, bytes: &[u8]) -> Result<String, codec::DecodeError> {
    visit(schema, bytes, |message| format!("{message:#?}"))
}

/// The header of a message, by the name in its schema.
pub fn header(schema: &str, bytes: &[u8]) -> Result<Header, codec::DecodeError> {
    visit(schema, bytes, |message| *message.header())
}

/// What every message can do.
trait Shown: std::fmt::Debug {
    fn header(&self) -> &Header;
}

impl<M: Message + std::fmt::Debug> Shown for M {
    fn header(&self) -> &Header {
        Message::header(self)
    }
}

fn visit<T>(schema: &str, bytes: &[u8], see: impl FnOnce(&dyn Shown) -> T) -> Result<T, codec::DecodeError> {
    macro_rules! any {
        ($($message:ty),*) => {
            match schema.split('@').next().unwrap_or("") {
                $(<$message as Message>::NAME => decode::<$message>(schema, bytes).map(|message| see(&message)),)*
                _ => Err(codec::unknown(schema)),
            }
        };
    }
    wire::for_all_messages!(any)
}

fn decode<M: Message>(schema: &str, bytes: &[u8]) -> Result<M, codec::DecodeError> {
    codec::check_schema::<M>(schema)?;
    codec::decode(bytes)
}
