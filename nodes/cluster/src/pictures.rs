//! The points of each picture, so that a picture that comes again, better placed, takes its own place.

use crate::ball::Sample;
use std::collections::BTreeMap;

/// By the stamps of the pictures.
#[derive(Default)]
pub struct Pictures {
    held: BTreeMap<i64, Held>,
}

struct Held {
    revision: u32,
    samples: Vec<Sample>,
}

impl Pictures {
    /// Takes out what a picture brought under a lower revision.
    pub fn outdated(&mut self, stamp_nanos: i64, revision: u32) -> Vec<Sample> {
        match self.held.get(&stamp_nanos) {
            Some(held) if held.revision < revision => {
                self.held.remove(&stamp_nanos).map_or(vec![], |held| held.samples)
            }
            _ => Vec::new(),
        }
    }

    /// Adds points to a picture.
    pub fn keep(&mut self, stamp_nanos: i64, revision: u32, samples: Vec<Sample>) {
        if samples.is_empty() {
            return;
        }
        let held = self.held.entry(stamp_nanos).or_insert(Held { revision, samples: Vec::new() });
        // A picture often comes in one piece.
        if held.samples.is_empty() {
            held.samples = samples;
        } else {
            held.samples.extend(samples);
        }
    }
}
