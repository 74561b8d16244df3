//! The cloud so far, put together from changes.

use std::collections::BTreeMap;
use wire::{Cloud, CloudPoint, Extent};

/// The balls of one scan as they stand, by their numbers.
#[derive(Debug, Default)]
pub(crate) struct HeldCloud {
    of: Option<(u64, u32)>,
    balls: BTreeMap<u32, CloudPoint>,
}

impl HeldCloud {
    /// Takes a message; what belongs to an older scan or revision than is held comes too late and is passed over.
    pub fn take(&mut self, cloud: &Cloud) {
        let of = Some((cloud.header.scan, cloud.header.revision));
        if of < self.of {
            return;
        }
        let is_later = self.of.is_some_and(|(scan, _)| cloud.header.scan > scan);
        if is_later || cloud.extent == Extent::Whole {
            self.balls.clear();
        }
        self.of = of;
        for ball in cloud.points.iter() {
            if ball.count > 0 {
                self.balls.insert(ball.id, *ball);
            } else {
                self.balls.remove(&ball.id);
            }
        }
    }

    /// The same if they are of this scan; otherwise none.
    pub fn points_of(&self, scan: u64) -> Vec<CloudPoint> {
        if self.of.is_some_and(|(held, _)| held == scan) { self.points() } else { Vec::new() }
    }

    /// The balls in the order of their numbers.
    pub fn points(&self) -> Vec<CloudPoint> {
        self.balls.values().copied().collect()
    }
}
