//! Keeps what a scan is made of, in an MCAP file (<https://mcap.dev>), which any MCAP tool can open: poses, stripes, pictures
//! for colour, calibration and the operator's phases; pictures of the laser's line, which are most of the bytes and have
//! become stripes already, when `pictures = "all"`.
//!
//! | in | out |
//! |---|---|
//! | each of those messages: key, schema, stamp, bytes | one file: a channel for each key and schema, the bytes as they came |
//!
//! Nothing is decoded or encoded again, so a recording is exactly what the nodes heard. A channel's schema is named as it
//! travels beside the message (`Frame@1:…`), and its data is the layout in words ([`wire::catalogue`]), so that a recording
//! can be understood without this program. `log_time` is the stamp of the message (MCAP knows no time before zero: an
//! earlier stamp stands as 0; the bytes keep it). Configuration and version go into the metadata record `limn`.
//!
//! A file grows by whole chunks, each written at once when it is large enough or holds enough time ([`Config`]); after a
//! crash all but the last chunk can be read, without the index at the end of the file (crate `replay`). A recorder that was
//! started again goes on in a second file beside the first ([`Recorder::go_on`]); what was in the last chunk it gets once more
//! from the senders' own memory, and both files are read as one.
//!
//! ```
//! use record::{Config, Recorder};
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("scan.mcap");
//! let metadata = [("limn_version".to_owned(), "0.1.0".to_owned())].into();
//! let mut recorder = Recorder::create(&path, Config::default(), &metadata).unwrap();
//! recorder.write("tracker/head/pose", "Pose@1:00", 1_000, &[1, 2, 3]).unwrap();
//! let kept = recorder.finish().unwrap();
//! assert_eq!(kept.messages, 1);
//! ```

mod config;
#[cfg(feature = "node")]
pub mod node;
mod recorder;

pub use config::{Config, ConfigError};
pub use recorder::{Kept, METADATA, RecordError, Recorder};
