//! From record to record through an MCAP file, without trusting its index: each record is an opcode, a length and a body
//! (<https://mcap.dev/spec>, "Records"). Bodies of chunks are stepped over.

use crate::Damage;
use mcap::records::{Record, op};
use mcap::{MAGIC, parse_record};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::Path;

/// Opcode and length.
pub(crate) const PREFIX_BYTES: u64 = 9;
/// Records outside of chunks are small; a longer one is a damaged length.
const MAX_SMALL_BYTES: u64 = 1 << 28;
/// The footer behind its prefix, and the magic at the end.
const FOOTER_BYTES: u64 = 20;

/// A chunk in the file.
#[derive(Debug, Clone, Default)]
pub(crate) struct ChunkPlace {
    /// Of its prefix.
    pub at: u64,
    /// With its prefix.
    pub length: u64,
    /// Messages by channel, from the index behind it.
    pub messages: BTreeMap<u16, u64>,
}

/// What the walk met.
#[derive(Debug, Default)]
pub(crate) struct Walk {
    pub chunks: Vec<ChunkPlace>,
    pub schemas: BTreeMap<u16, String>,
    /// Key and number of the schema.
    pub channels: BTreeMap<u16, (String, u16)>,
    pub metadata: BTreeMap<String, BTreeMap<String, String>>,
    pub damage: Option<Damage>,
}

/// Walks the whole file; where it cannot go on, the index at the end of the file is asked for what follows.
pub(crate) fn walk(path: &Path, file: &mut File) -> io::Result<Walk> {
    let length = file.metadata()?.len();
    let mut walk = Walk::default();
    let stopped = walk.records(file, MAGIC.len() as u64, length)?;
    if let Some((at, reason)) = stopped {
        let mut bytes = length - at;
        if let Some(summary) = summary_start(file, length)?.filter(|&start| start > at) {
            let known: BTreeSet<u64> = walk.chunks.iter().map(|c| c.at).collect();
            let mut index = Walk::default();
            if index.records(file, summary, length)?.is_none() {
                let found = index.chunks.into_iter().filter(|c| c.at >= at && !known.contains(&c.at));
                let found: Vec<ChunkPlace> = found.collect();
                bytes = found.first().map_or(summary, |c| c.at) - at;
                walk.chunks.extend(found);
                walk.schemas.extend(index.schemas);
                walk.channels.extend(index.channels);
            }
        }
        walk.damage = Some(Damage { path: path.to_owned(), at, bytes, reason });
    }
    Ok(walk)
}

/// Where the index begins, by the footer.
fn summary_start(file: &mut File, length: u64) -> io::Result<Option<u64>> {
    let tail = PREFIX_BYTES + FOOTER_BYTES + MAGIC.len() as u64;
    if length < tail + MAGIC.len() as u64 {
        return Ok(None);
    }
    let body = read_at(file, length - tail + PREFIX_BYTES, FOOTER_BYTES)?;
    Ok(match parse_record(op::FOOTER, &body) {
        Ok(Record::Footer(footer)) if footer.summary_start > 0 && footer.summary_start < length => {
            Some(footer.summary_start)
        }
        _ => None,
    })
}

impl Walk {
    /// Takes records until the footer; returns where and why it had to stop before.
    fn records(&mut self, file: &mut File, from: u64, length: u64) -> io::Result<Option<(u64, String)>> {
        let mut at = from;
        loop {
            let stop = |reason: &str| Ok(Some((at, reason.to_owned())));
            if length.saturating_sub(at) < PREFIX_BYTES {
                return stop("it ends without a footer");
            }
            let prefix = read_at(file, at, PREFIX_BYTES)?;
            let (opcode, size) = split_prefix(&prefix);
            if size > length - at - PREFIX_BYTES {
                return stop("it ends inside a record");
            }
            match opcode {
                op::FOOTER => return Ok(None),
                op::CHUNK => {
                    let chunk = ChunkPlace { at, length: PREFIX_BYTES + size, ..ChunkPlace::default() };
                    self.chunks.push(chunk);
                }
                op::SCHEMA | op::CHANNEL | op::MESSAGE_INDEX | op::METADATA | op::CHUNK_INDEX => {
                    if size > MAX_SMALL_BYTES {
                        return stop("a record is too long");
                    }
                    let body = read_at(file, at + PREFIX_BYTES, size)?;
                    match parse_record(opcode, &body) {
                        Ok(record) => self.take(record),
                        Err(e) => return stop(&format!("a record cannot be read: {e}")),
                    }
                }
                // Attachments, statistics and what later versions of MCAP may add.
                op::HEADER..=op::DATA_END | 0x80.. => {}
                _ => return stop(&format!("there is no record of kind {opcode}")),
            }
            at += PREFIX_BYTES + size;
        }
    }

    pub fn take(&mut self, record: Record<'_>) {
        match record {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                self.channels.insert(channel.id, (channel.topic, channel.schema_id));
            }
            Record::MessageIndex(index) => {
                if let Some(chunk) = self.chunks.last_mut() {
                    chunk.messages.insert(index.channel_id, index.records.len() as u64);
                }
            }
            Record::ChunkIndex(index) => {
                let (at, length) = (index.chunk_start_offset, index.chunk_length);
                // In the order of the file the chunks are known already; only a walk of the index alone needs these.
                if self.chunks.iter().all(|c| c.at != at) {
                    self.chunks.push(ChunkPlace { at, length, ..ChunkPlace::default() });
                }
            }
            Record::Metadata(metadata) => {
                self.metadata.insert(metadata.name, metadata.metadata);
            }
            _ => {}
        }
    }
}

fn split_prefix(prefix: &[u8]) -> (u8, u64) {
    let length = prefix.get(1..9).and_then(|b| b.try_into().ok()).map_or(0, u64::from_le_bytes);
    (prefix.first().copied().unwrap_or(0), length)
}

/// Bytes that are known to be there: the caller has held them against the length of the file.
pub(crate) fn read_at(file: &mut File, at: u64, length: u64) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(at))?;
    let mut bytes = vec![0; usize::try_from(length).map_err(io::Error::other)?];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}
