//! Plays what was recorded: an MCAP file (crate `record`) or a scan folder, as the same messages in the same order.
//!
//! | in | out |
//! |---|---|
//! | scan.mcap | every message, in the order in which it was recorded: key, schema, stamp, bytes as they were |
//! | a scan folder | rig/…/calibration, then poses and frames by their stamps, then the end of each stream |
//!
//! A recording that was cut short or damaged is read as far as it goes: [`Recording::damages`] says what is missing, a
//! damaged chunk in the middle is one error among the messages and the rest follows. One whose recorder died and was started
//! again goes on in scan.2.mcap, and is read as one. Nothing is decoded here but headers;
//! [`Message::decode`] checks the schema first and names both versions when they differ.
//!
//! ```
//! use replay::Source;
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("scan.mcap");
//! let mut recorder = record::Recorder::create(&path, record::Config::default(), &Default::default()).unwrap();
//! recorder.write("tracker/head/pose", "Pose@1:00", 1_000, &[1, 2, 3]).unwrap();
//! recorder.finish().unwrap();
//!
//! let source = Source::open(&path).unwrap();
//! let messages: Vec<_> = source.messages().unwrap().collect::<Result<_, _>>().unwrap();
//! assert_eq!((messages[0].key.as_str(), messages[0].bytes.as_slice()), ("tracker/head/pose", &[1, 2, 3][..]));
//! ```

mod chunk;
mod error;
mod folder;
mod message;
#[cfg(feature = "node")]
pub mod node;
mod part;
mod recording;
mod source;
mod walk;

pub use error::{Damage, ReplayError};
pub use folder::{FolderScan, Names};
pub use message::Message;
pub use recording::{Messages, Recording, Stream};
pub use source::Source;
