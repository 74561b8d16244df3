//! Messages into an MCAP file.

use crate::{Config, ConfigError};
use mcap::records::{MessageHeader, Metadata};
use mcap::{Compression, McapError, WriteOptions, Writer};
use std::collections::BTreeMap;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// The name of the metadata record that says what was recorded and how.
pub const METADATA: &str = "limn";

const MESSAGE_ENCODING: &str = "bincode";
const SCHEMA_ENCODING: &str = "limn";
/// What stands for the layout of a message that this version does not know.
const UNKNOWN_LAYOUT: &str = "// written by another version of limn";

/// Why a message could not be kept.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// Bad numbers.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The file could not be made; one that is there already is never overwritten.
    #[error("{}: cannot be made: {source}", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// What would be taken for its second part is there already.
    #[error("{} is there already, and would be taken for a part of {}: move it away", part.display(), path.display())]
    Part {
        /// The file.
        path: PathBuf,
        /// The other one.
        part: PathBuf,
    },
    /// The file could not be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: McapError,
    },
}

/// What a finished recording holds.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Kept {
    /// All messages.
    pub messages: u64,
    /// All their bytes, before compression.
    pub bytes: u64,
    /// Messages of each key.
    pub by_key: BTreeMap<String, u64>,
}

#[derive(Debug)]
struct Channel {
    id: u16,
    written: u32,
}

/// An open recording. Dropped without [`Recorder::finish`], it still closes its file.
pub struct Recorder {
    path: PathBuf,
    writer: Writer<File>,
    chunk_nanos: i64,
    /// The earliest and latest stamp of the open chunk.
    chunk_span: Option<(i64, i64)>,
    layouts: BTreeMap<String, String>,
    channels: BTreeMap<String, BTreeMap<String, Channel>>,
    kept: Kept,
}

impl Recorder {
    /// Begins a file. The metadata say what is recorded: effective configuration, version, calibration.
    pub fn create(path: &Path, config: Config, metadata: &BTreeMap<String, String>) -> Result<Self, RecordError> {
        let part = formats::recording_part(path, 2);
        if part.exists() {
            return Err(RecordError::Part { path: path.to_owned(), part });
        }
        Self::begin(path, config, metadata.clone())
    }

    /// Goes on with a recording whose recorder has died, in its next part ([`formats::recording_part`]): what was written
    /// before stays as it is. Whoever reads the first part reads them all.
    pub fn go_on(path: &Path, config: Config, metadata: &BTreeMap<String, String>) -> Result<Self, RecordError> {
        let there = formats::recording_parts(path).take_while(|part| part.exists()).count();
        let next = u32::try_from(there).unwrap_or(u32::MAX).saturating_add(1);
        let mut metadata = metadata.clone();
        if next > 1 {
            metadata.insert(formats::RECORDING_PART.to_owned(), next.to_string());
        }
        Self::begin(&formats::recording_part(path, next), config, metadata)
    }

    fn begin(path: &Path, config: Config, metadata: BTreeMap<String, String>) -> Result<Self, RecordError> {
        config.check()?;
        let create = |source| RecordError::Create { path: path.to_owned(), source };
        let file = File::create_new(path).map_err(create)?;
        let options = WriteOptions::new()
            .profile("limn")
            .library(concat!("limn ", env!("CARGO_PKG_VERSION")))
            .compression((config.zstd_level > 0).then_some(Compression::Zstd))
            .compression_level(config.zstd_level)
            .chunk_size(Some(u64::from(config.chunk_mb) << 20))
            // A chunk is gathered in memory and reaches the file whole.
            .disable_seeking(true);
        let write = |source| RecordError::Write { path: path.to_owned(), source };
        let mut writer = options.create(file).map_err(write)?;
        writer.write_metadata(&Metadata { name: METADATA.into(), metadata }).map_err(write)?;
        Ok(Self {
            path: path.to_owned(),
            writer,
            chunk_nanos: (config.chunk_s * 1e9) as i64,
            chunk_span: None,
            layouts: wire::catalogue(),
            channels: BTreeMap::new(),
            kept: Kept::default(),
        })
    }

    /// Keeps one message, as it came.
    pub fn write(&mut self, key: &str, schema: &str, stamp_nanos: i64, bytes: &[u8]) -> Result<(), RecordError> {
        self.put(key, schema, stamp_nanos, bytes)
            .map_err(|source| RecordError::Write { path: self.path.clone(), source })
    }

    fn put(&mut self, key: &str, schema: &str, stamp_nanos: i64, bytes: &[u8]) -> Result<(), McapError> {
        let (first, last) = self.chunk_span.unwrap_or((stamp_nanos, stamp_nanos));
        let span = (first.min(stamp_nanos), last.max(stamp_nanos));
        if span.1.saturating_sub(span.0) > self.chunk_nanos {
            self.writer.flush()?;
            self.chunk_span = Some((stamp_nanos, stamp_nanos));
        } else {
            self.chunk_span = Some(span);
        }
        let channel = self.channel(key, schema)?;
        let time = u64::try_from(stamp_nanos).unwrap_or(0);
        let header =
            MessageHeader { channel_id: channel.id, sequence: channel.written, log_time: time, publish_time: time };
        channel.written = channel.written.wrapping_add(1);
        self.writer.write_to_known_channel(&header, bytes)?;
        self.kept.messages += 1;
        self.kept.bytes += bytes.len() as u64;
        *self.kept.by_key.entry(key.to_owned()).or_default() += 1;
        Ok(())
    }

    fn channel(&mut self, key: &str, schema: &str) -> Result<&mut Channel, McapError> {
        let by_schema = self.channels.entry(key.to_owned()).or_default();
        if !by_schema.contains_key(schema) {
            let layout = self.layouts.get(schema).map_or(UNKNOWN_LAYOUT, String::as_str);
            let schema_id = self.writer.add_schema(schema, SCHEMA_ENCODING, layout.as_bytes())?;
            let id = self.writer.add_channel(schema_id, key, MESSAGE_ENCODING, &BTreeMap::new())?;
            by_schema.insert(schema.to_owned(), Channel { id, written: 0 });
        }
        by_schema.get_mut(schema).ok_or(McapError::BadIndex)
    }

    /// Closes the open chunk, so that all that has come can be read even when the program is killed now.
    pub fn flush(&mut self) -> Result<(), RecordError> {
        self.chunk_span = None;
        self.writer.flush().map_err(|source| RecordError::Write { path: self.path.clone(), source })
    }

    /// The file that is being written.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What has been kept so far.
    pub fn kept(&self) -> &Kept {
        &self.kept
    }

    /// Writes the index and closes the file.
    pub fn finish(mut self) -> Result<Kept, RecordError> {
        let finished = self.writer.finish();
        finished.map_err(|source| RecordError::Write { path: self.path.clone(), source })?;
        Ok(std::mem::take(&mut self.kept))
    }
}
