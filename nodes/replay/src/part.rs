//! One MCAP file: a recording, or a part of it.

use crate::walk::{ChunkPlace, Walk, read_at, walk};
use crate::{Message, ReplayError, chunk};
use mcap::MAGIC;
use mcap::records::Record;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::vec;

/// The metadata record of our recorder.
const METADATA: &str = "limn";

/// A file that is open for reading.
#[derive(Debug)]
pub(crate) struct Part {
    path: PathBuf,
    pub walk: Walk,
}

impl Part {
    /// Looks through a file. One that was not closed is taken as far as it goes.
    pub fn open(path: &Path) -> Result<Self, ReplayError> {
        let io = |source| ReplayError::Io { path: path.to_owned(), source };
        let foreign = |what: &str| ReplayError::Foreign { path: path.to_owned(), what: what.to_owned() };
        let mut file = File::open(path).map_err(io)?;
        let mut magic = Vec::new();
        file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut magic).map_err(io)?;
        if magic != MAGIC {
            return Err(foreign("it does not begin as an MCAP file does"));
        }
        let mut walk = walk(path, &mut file).map_err(io)?;
        learn_channels(&mut file, &mut walk);
        Ok(Self { path: path.to_owned(), walk })
    }

    /// What the recorder noted.
    pub fn notes(&self) -> Option<&BTreeMap<String, String>> {
        self.walk.metadata.get(METADATA)
    }

    /// All messages in the order in which they were recorded.
    pub fn messages(&self) -> Result<PartMessages<'_>, ReplayError> {
        let io = |source| ReplayError::Io { path: self.path.clone(), source };
        let file = File::open(&self.path).map_err(io)?;
        Ok(PartMessages {
            part: self,
            file,
            chunks: self.walk.chunks.iter(),
            schemas: self.walk.schemas.clone(),
            channels: self.walk.channels.clone(),
            records: Vec::new().into_iter(),
        })
    }
}

/// A file that was not closed names its channels inside the chunks only: those whose channels are unknown are read for
/// them. A chunk that cannot be read says so when its messages are asked for.
fn learn_channels(file: &mut File, walk: &mut Walk) {
    for place in walk.chunks.clone() {
        if place.messages.is_empty() || place.messages.keys().any(|id| !walk.channels.contains_key(id)) {
            let records = read_chunk(file, &place).unwrap_or_default();
            let declares = |record: &Record<'_>| matches!(record, Record::Schema { .. } | Record::Channel(_));
            records.into_iter().filter(declares).for_each(|record| walk.take(record));
        }
    }
}

fn read_chunk(file: &mut File, place: &ChunkPlace) -> Result<Vec<Record<'static>>, String> {
    let there = file.metadata().map_err(|e| e.to_string())?.len();
    if place.at.checked_add(place.length).is_none_or(|end| end > there) {
        return Err("it lies outside the file".into());
    }
    let bytes = read_at(file, place.at, place.length).map_err(|e| e.to_string())?;
    chunk::records(&bytes).map_err(|e| e.to_string())
}

/// The messages of a file, read chunk by chunk.
#[derive(Debug)]
pub(crate) struct PartMessages<'a> {
    part: &'a Part,
    file: File,
    chunks: std::slice::Iter<'a, ChunkPlace>,
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, (String, u16)>,
    records: vec::IntoIter<Record<'static>>,
}

impl Iterator for PartMessages<'_> {
    type Item = Result<Message, ReplayError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            for record in self.records.by_ref() {
                match record {
                    Record::Schema { header, .. } => {
                        self.schemas.insert(header.id, header.name);
                    }
                    Record::Channel(channel) => {
                        self.channels.insert(channel.id, (channel.topic, channel.schema_id));
                    }
                    Record::Message { header, data } => {
                        // A message without its channel cannot be placed; a whole chunk always names them.
                        let Some((key, schema_id)) = self.channels.get(&header.channel_id) else { continue };
                        return Some(Ok(Message {
                            key: key.clone(),
                            schema: self.schemas.get(schema_id).cloned().unwrap_or_default(),
                            stamp_nanos: i64::try_from(header.log_time).unwrap_or(i64::MAX),
                            bytes: data.into_owned(),
                        }));
                    }
                    _ => {}
                }
            }
            let place = self.chunks.next()?;
            match read_chunk(&mut self.file, place) {
                Ok(records) => self.records = records.into_iter(),
                Err(reason) => {
                    let (path, messages) = (self.part.path.clone(), place.messages.values().sum());
                    return Some(Err(ReplayError::Chunk { path, at: place.at, messages, reason }));
                }
            }
        }
    }
}
