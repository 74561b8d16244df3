//! Which ball a point belongs to, with one look into a hash.
//!
//! Space is cut into cells with an edge of D. A centre is entered into every cell that its ball reaches into (21 of them
//! on average), so a point finds all centres within D of it in the list of its own cell: on a surface about six,
//! side by side in memory. Founding a ball is the dear part and rare; asking is cheap and common.

/// How many centres stand in one block of a cell's list; one block is enough on a surface.
const LANES: usize = 8;
/// Cell indices are packed into a key with so many bits each.
const BITS: u32 = 21;
const HALF: i32 = 1 << (BITS - 1);
const NONE: u32 = u32::MAX;
const EMPTY: u64 = u64::MAX;
/// Cells are entered this much beyond D, which is more than the rounding of f32 distances.
const REACH_SLACK: f64 = 1e-6;

/// The square of a distance: the one formula by which "within D" and "closest" are decided.
pub fn distance_squared(a: [f32; 3], b: [f32; 3]) -> f32 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    x * x + y * y + z * z
}

/// A block of a cell's list. Unused lanes are at infinity, so that all can be measured without asking.
#[derive(Clone)]
struct Block {
    x: [f32; LANES],
    y: [f32; LANES],
    z: [f32; LANES],
    ball: [u32; LANES],
    used: u32,
    next: u32,
}

const FREE: Block = Block {
    x: [f32::INFINITY; LANES],
    y: [f32::INFINITY; LANES],
    z: [f32::INFINITY; LANES],
    ball: [NONE; LANES],
    used: 0,
    next: NONE,
};

#[derive(Clone, Copy)]
struct Slot {
    key: u64,
    block: u32,
}

/// The centres by cells.
pub struct CentreGrid {
    cells_per_metre: f64,
    radius_m: f64,
    radius_squared: f32,
    /// Open addressing with linear probing; the length is a power of two.
    slots: Vec<Slot>,
    occupied: usize,
    blocks: Vec<Block>,
    /// The last cell asked for: the points of a stripe come in rows.
    recent: Slot,
}

impl CentreGrid {
    /// Without centres.
    pub fn new(radius_m: f32) -> Self {
        const FIRST_SLOTS: usize = 1 << 12;
        Self {
            cells_per_metre: 1.0 / f64::from(radius_m),
            radius_m: f64::from(radius_m),
            radius_squared: radius_m * radius_m,
            slots: vec![Slot { key: EMPTY, block: NONE }; FIRST_SLOTS],
            occupied: 0,
            blocks: Vec::new(),
            recent: Slot { key: EMPTY, block: NONE },
        }
    }

    /// The cell of a point; `None` more than 2^20 cells from the origin.
    fn key(&self, p: [f32; 3]) -> Option<u64> {
        let shifted = p.map(|c| f64::from(c) * self.cells_per_metre + f64::from(HALF));
        let inside = |c: f64| c >= 1.0 && c < f64::from(2 * HALF - 1);
        // Positive numbers: cutting the fraction off is rounding down.
        shifted.iter().all(|&c| inside(c)).then(|| pack(shifted.map(|c| c as i32 - HALF)))
    }

    /// True when a point lies where cells have numbers.
    pub fn reaches(&self, p: [f32; 3]) -> bool {
        self.key(p).is_some()
    }

    /// The ball with the closest centre, when that is within D, and the square of the distance. Of two that are equally
    /// close the older one.
    pub fn closest(&mut self, p: [f32; 3]) -> Option<(u32, f32)> {
        let key = self.key(p)?;
        if key != self.recent.key {
            self.recent = Slot { key, block: self.slots[self.probe(key)].block };
        }
        let mut best = (NONE, f32::INFINITY);
        let mut at = self.recent.block;
        while at != NONE {
            let block = &self.blocks[at as usize];
            let mut squared = [0.0; LANES];
            for (lane, d) in squared.iter_mut().enumerate() {
                *d = distance_squared([block.x[lane], block.y[lane], block.z[lane]], p);
            }
            for (lane, &d) in squared.iter().enumerate() {
                if d < best.1 {
                    best = (block.ball[lane], d);
                }
            }
            at = block.next;
        }
        (best.1 <= self.radius_squared).then_some(best)
    }

    /// Enters a centre.
    pub fn insert(&mut self, ball: u32, centre: [f32; 3]) {
        self.recent.key = EMPTY;
        let mut keys = Vec::new();
        self.cells_around(centre, self.radius_m, |key| keys.push(key));
        for key in keys {
            let first = self.first_block(key);
            self.append(first, ball, centre);
        }
    }

    /// All balls whose centres are at most `reach_m` (>= D) from a point, and perhaps some that are farther: sorted.
    pub fn near(&self, p: [f32; 3], reach_m: f64, balls: &mut Vec<u32>) {
        balls.clear();
        // On the way to such a centre lies a point that is within D of it: its cell lists the ball.
        self.cells_around(p, reach_m - self.radius_m, |key| {
            let mut at = self.slots[self.probe(key)].block;
            while at != NONE {
                let block = &self.blocks[at as usize];
                balls.extend_from_slice(&block.ball[..block.used as usize]);
                at = block.next;
            }
        });
        balls.sort_unstable();
        balls.dedup();
    }

    /// Calls for every cell that a ball reaches into.
    fn cells_around(&self, centre: [f32; 3], radius_m: f64, mut visit: impl FnMut(u64)) {
        let reach = radius_m * self.cells_per_metre + REACH_SLACK;
        let centre = centre.map(|c| f64::from(c) * self.cells_per_metre);
        let from = centre.map(|c| (c - reach).floor() as i32);
        let to = centre.map(|c| (c + reach).floor() as i32);
        let gap = |axis: usize, cell: i32| {
            let low = f64::from(cell);
            (low - centre[axis]).max(centre[axis] - low - 1.0).max(0.0)
        };
        for x in from[0]..=to[0] {
            for y in from[1]..=to[1] {
                for z in from[2]..=to[2] {
                    let squared = gap(0, x).powi(2) + gap(1, y).powi(2) + gap(2, z).powi(2);
                    if squared <= reach * reach && [x, y, z].iter().all(|c| (-HALF..HALF).contains(c)) {
                        visit(pack([x, y, z]));
                    }
                }
            }
        }
    }

    /// The slot of a key, or the free one where it would go.
    fn probe(&self, key: u64) -> usize {
        let mask = self.slots.len() - 1;
        // Fibonacci hashing: the upper bits of the product are the well mixed ones.
        let mut at = (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize & mask;
        while self.slots[at].key != key && self.slots[at].key != EMPTY {
            at = (at + 1) & mask;
        }
        at
    }

    fn first_block(&mut self, key: u64) -> u32 {
        let at = self.probe(key);
        if self.slots[at].key == key {
            return self.slots[at].block;
        }
        let block = self.new_block();
        self.slots[at] = Slot { key, block };
        self.occupied += 1;
        if 2 * self.occupied > self.slots.len() {
            self.grow();
        }
        block
    }

    fn new_block(&mut self) -> u32 {
        self.blocks.push(FREE);
        (self.blocks.len() - 1) as u32
    }

    fn append(&mut self, first: u32, ball: u32, centre: [f32; 3]) {
        let mut at = first;
        while self.blocks[at as usize].next != NONE {
            at = self.blocks[at as usize].next;
        }
        if self.blocks[at as usize].used as usize == LANES {
            let next = self.new_block();
            self.blocks[at as usize].next = next;
            at = next;
        }
        let block = &mut self.blocks[at as usize];
        let lane = block.used as usize;
        [block.x[lane], block.y[lane], block.z[lane]] = centre;
        block.ball[lane] = ball;
        block.used += 1;
    }

    fn grow(&mut self) {
        let larger = vec![Slot { key: EMPTY, block: NONE }; 2 * self.slots.len()];
        for slot in std::mem::replace(&mut self.slots, larger) {
            if slot.key != EMPTY {
                let at = self.probe(slot.key);
                self.slots[at] = slot;
            }
        }
    }
}

fn pack(cell: [i32; 3]) -> u64 {
    let [x, y, z] = cell.map(|c| u64::from((c + HALF) as u32));
    (x << (2 * BITS)) | (y << BITS) | z
}
