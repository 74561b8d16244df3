//! A recording as a row of messages: an MCAP file, and those in which its recorder went on when it was started again.

use crate::part::{Part, PartMessages};
use crate::{Damage, Message, ReplayError};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use wire::codec;

/// One topic of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stream {
    /// The key of the topic.
    pub key: String,
    /// Name, version and layout of its messages.
    pub schema: String,
    /// How many there are, as far as the file says (a damaged one may not, and what is in two parts counts twice).
    pub messages: u64,
}

/// A recording that is open for reading.
#[derive(Debug)]
pub struct Recording {
    parts: Vec<Part>,
    damages: Vec<Damage>,
}

impl Recording {
    /// Looks through a file and its further parts ([`formats::recording_part`]). What was not closed is taken as far as it
    /// goes: see [`Self::damages`].
    pub fn open(path: &Path) -> Result<Self, ReplayError> {
        let mut parts = vec![Part::open(path)?];
        let mut unread = Vec::new();
        for path in formats::recording_parts(path).skip(1) {
            match Part::open(&path) {
                Ok(part) if !part.notes().is_some_and(|notes| notes.contains_key(formats::RECORDING_PART)) => break,
                Ok(part) => parts.push(part),
                // The first part is worth reading all the same.
                Err(error) => unread.push(Damage { path, at: 0, bytes: 0, reason: error.to_string() }),
            }
        }
        let damages = parts.iter().filter_map(|part| part.walk.damage.clone()).chain(unread).collect();
        Ok(Self { parts, damages })
    }

    /// What is missing of files that were cut short or damaged; empty for whole ones. Single damaged chunks show only
    /// among the [`messages`](Self::messages).
    pub fn damages(&self) -> &[Damage] {
        &self.damages
    }

    /// What the recorder noted: configuration, version, calibration.
    pub fn metadata(&self) -> BTreeMap<String, String> {
        self.parts.iter().find_map(Part::notes).cloned().unwrap_or_default()
    }

    /// The topics, by key and schema.
    pub fn streams(&self) -> Vec<Stream> {
        let mut streams: BTreeMap<(&str, &str), u64> = BTreeMap::new();
        for walk in self.parts.iter().map(|part| &part.walk) {
            for (id, (key, schema_id)) in &walk.channels {
                let schema = walk.schemas.get(schema_id).map_or("", String::as_str);
                let count: u64 = walk.chunks.iter().filter_map(|c| c.messages.get(id)).sum();
                *streams.entry((key, schema)).or_default() += count;
            }
        }
        let stream = |((key, schema), messages): ((&str, &str), u64)| Stream {
            key: key.to_owned(),
            schema: schema.to_owned(),
            messages,
        };
        streams.into_iter().map(stream).collect()
    }

    /// All messages in the order in which they were recorded. What a recorder that was started again got once more comes
    /// once.
    pub fn messages(&self) -> Result<Messages<'_>, ReplayError> {
        let parts = self.parts.iter().map(Part::messages).collect::<Result<Vec<_>, _>>()?;
        let seen = (parts.len() > 1).then(BTreeMap::new);
        Ok(Messages { parts: parts.into_iter(), part: None, seen })
    }
}

/// Of each key, which messages have come: scan, number and stamp.
type Seen = BTreeMap<String, BTreeSet<(u64, u64, i64)>>;

/// The messages of a recording. An error stands for what it names; what follows it can be read.
#[derive(Debug)]
pub struct Messages<'a> {
    parts: std::vec::IntoIter<PartMessages<'a>>,
    part: Option<PartMessages<'a>>,
    /// For a recording of several parts.
    seen: Option<Seen>,
}

impl Iterator for Messages<'_> {
    type Item = Result<Message, ReplayError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.part.as_mut().and_then(Iterator::next) {
                Some(Ok(message)) if self.seen.as_mut().is_some_and(|seen| !is_new(seen, &message)) => {}
                Some(message) => return Some(message),
                None => self.part = Some(self.parts.next()?),
            }
        }
    }
}

fn is_new(seen: &mut Seen, message: &Message) -> bool {
    let Ok(header) = codec::header(&message.bytes) else { return true };
    let place = (header.scan, header.seq, header.stamp_nanos);
    match seen.get_mut(&message.key) {
        Some(places) => places.insert(place),
        None => {
            seen.insert(message.key.clone(), BTreeSet::from([place]));
            true
        }
    }
}
