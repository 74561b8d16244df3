//! The points that may yet go to another ball.
//!
//! A ball that is founded later lies more than D from every centre. To take a point that is r from its centre it must be
//! closer than r to it, so D < 2 r: a point within D/2 of its centre stays for ever and need not be kept. The others are
//! kept, 24 bytes each (about half of all points), in blocks that are linked up per ball.

use crate::ball::Sample;

/// Points in one block: small enough that a ball with few points wastes little.
const SAMPLES: usize = 8;
/// The end of a list.
pub const END: u32 = u32::MAX;
/// The part of D squared up to which a point stays: D/2 squared, less more than the rounding of f32.
pub const SETTLED: f32 = 0.2499;

#[derive(Clone)]
struct Block {
    samples: [Sample; SAMPLES],
    used: u32,
    next: u32,
}

/// The lists of all balls.
pub struct MovablePoints {
    blocks: Vec<Block>,
    /// The list of blocks that were emptied.
    free: u32,
}

impl MovablePoints {
    /// No lists yet.
    pub fn new() -> Self {
        Self { blocks: Vec::new(), free: END }
    }

    /// Puts a point in front of a list, whose first block is `list`.
    pub fn push(&mut self, list: &mut u32, sample: Sample) {
        let full = |block: &Block| block.used as usize == SAMPLES;
        if *list == END || full(&self.blocks[*list as usize]) {
            *list = self.take_block(*list);
        }
        let block = &mut self.blocks[*list as usize];
        block.samples[block.used as usize] = sample;
        block.used += 1;
    }

    /// Takes those points out of a list that are `wanted`.
    pub fn take(&mut self, list: &mut u32, mut wanted: impl FnMut(&Sample) -> bool, taken: &mut Vec<Sample>) {
        let mut at = *list;
        while at != END {
            let block = &mut self.blocks[at as usize];
            let next = block.next;
            let mut i = 0;
            while i < block.used as usize {
                if wanted(&block.samples[i]) {
                    taken.push(block.samples[i]);
                    block.used -= 1;
                    block.samples[i] = block.samples[block.used as usize];
                } else {
                    i += 1;
                }
            }
            at = next;
        }
        self.drop_empty_first(list);
    }

    /// Takes out one point that is the same as this.
    pub fn take_one(&mut self, list: &mut u32, sample: &Sample) {
        let (mut found, mut taken) = (false, Vec::new());
        let mut is_it = |held: &Sample| {
            let it = !found && held == sample;
            found |= it;
            it
        };
        self.take(list, &mut is_it, &mut taken);
    }

    /// How many bytes are held.
    pub fn bytes(&self) -> usize {
        self.blocks.capacity() * size_of::<Block>()
    }

    fn take_block(&mut self, next: u32) -> u32 {
        if self.free == END {
            self.blocks.push(Block { samples: [Sample::default(); SAMPLES], used: 0, next });
            return (self.blocks.len() - 1) as u32;
        }
        let block = self.free;
        self.free = std::mem::replace(&mut self.blocks[block as usize].next, next);
        block
    }

    fn drop_empty_first(&mut self, list: &mut u32) {
        while *list != END && self.blocks[*list as usize].used == 0 {
            let emptied = *list;
            *list = std::mem::replace(&mut self.blocks[emptied as usize].next, self.free);
            self.free = emptied;
        }
    }
}
