//! Pictures that wait for the final mesh, within a bound of memory.

use crate::Picture;

/// Keeps the working regions of lamp-lit frames. When the bound is reached, every second one is dropped, and from then
/// on only every second (fourth, eighth, ...) one is taken: what is kept is always spread evenly over the scan.
#[derive(Debug, Clone)]
pub struct FrameStore {
    bound_bytes: usize,
    bytes: usize,
    /// One in so many is kept.
    stride: u64,
    offered: u64,
    kept: Vec<(u64, Picture)>,
}

impl FrameStore {
    /// An empty store of at most so many bytes of pixels.
    pub fn new(bound_bytes: usize) -> Self {
        Self { bound_bytes, bytes: 0, stride: 1, offered: 0, kept: Vec::new() }
    }

    /// Offers a picture. One picture is kept even if it alone is larger than the bound.
    pub fn push(&mut self, picture: Picture) {
        let number = self.offered;
        self.offered += 1;
        if !number.is_multiple_of(self.stride) {
            return;
        }
        self.bytes += size_of(&picture);
        self.kept.push((number, picture));
        while self.bytes > self.bound_bytes && self.kept.len() > 1 {
            self.stride *= 2;
            let stride = self.stride;
            self.kept.retain(|(number, _)| number.is_multiple_of(stride));
            self.bytes = self.kept.iter().map(|(_, picture)| size_of(picture)).sum();
        }
    }

    /// The pictures that are kept, in the order in which they came.
    pub fn pictures(&self) -> impl ExactSizeIterator<Item = &Picture> {
        self.kept.iter().map(|(_, picture)| picture)
    }

    /// At most `count` of them, spread evenly: enough for a live preview.
    pub fn spread(&self, count: usize) -> impl Iterator<Item = &Picture> {
        let step = self.kept.len().div_ceil(count.max(1)).max(1);
        self.pictures().step_by(step)
    }

    /// How many pictures were offered and are not kept.
    pub fn thinned(&self) -> u64 {
        self.offered - self.kept.len() as u64
    }

    /// Bytes of pixels held.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Forgets everything: a new scan begins.
    pub fn clear(&mut self) {
        *self = Self::new(self.bound_bytes);
    }
}

fn size_of(picture: &Picture) -> usize {
    std::mem::size_of_val(picture.pixels.as_slice())
}
