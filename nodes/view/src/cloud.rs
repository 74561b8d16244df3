//! The cloud in chunks, so that only what changed is sent to the page again.

use std::collections::BTreeSet;
use wire::{Cloud, CloudPoint, Extent};

/// Balls in a chunk.
pub const CHUNK: usize = 4096;

/// All balls so far, by their numbers.
#[derive(Debug, Default)]
pub struct ChunkedCloud {
    points: Vec<Option<CloudPoint>>,
    changed: BTreeSet<usize>,
}

impl ChunkedCloud {
    /// Takes what changed, or all there is.
    pub fn take(&mut self, cloud: &Cloud) {
        if cloud.extent == Extent::Whole {
            self.changed.extend(0..self.points.len().div_ceil(CHUNK));
            self.points.fill(None);
        }
        for point in cloud.points.iter() {
            let id = point.id as usize;
            // A number far beyond what was ever counted is no ball of ours.
            if id > self.points.len() + cloud.points.len() {
                continue;
            }
            if id >= self.points.len() {
                self.points.resize(id + 1, None);
            }
            self.points[id] = Some(*point).filter(|point| point.count > 0);
            self.changed.insert(id / CHUNK);
        }
    }

    /// The chunks that changed since the last call: number and balls.
    pub fn changes(&mut self) -> Vec<(usize, Vec<CloudPoint>)> {
        let chunk = |number: usize| {
            let end = self.points.len().min((number + 1) * CHUNK);
            let points = self.points.get(number * CHUNK..end).unwrap_or_default();
            (number, points.iter().flatten().copied().collect())
        };
        std::mem::take(&mut self.changed).into_iter().map(chunk).collect()
    }
}
