//! Colour from cell to cell: the blur, and the spreading into cells that no picture coloured (paper, section 2.6).

use crate::atlas::{Atlas, NO_TEXEL};
use rayon::prelude::*;

/// The 1-2-1 / 2-4-2 / 1-2-1 blur of the cells that were seen. Cells without colour, and all beyond the border of the
/// chart, take no part: their share goes to the others.
pub fn blur(colours: &[Option<[f32; 3]>], atlas: &Atlas) -> Vec<Option<[f32; 3]>> {
    let blurred = |(number, colour): (usize, &Option<[f32; 3]>)| {
        let centre = (*colour)?;
        let mut mean = Mean::default();
        mean.add(&centre, 4.0);
        for (at, neighbour) in atlas.around(number as u32).into_iter().enumerate() {
            // Sides come first, corners last.
            let weight = if at < 4 { 2.0 } else { 1.0 };
            if neighbour != NO_TEXEL
                && let Some(colour) = &colours[neighbour as usize]
            {
                mean.add(colour, weight);
            }
        }
        mean.take()
    };
    colours.par_iter().enumerate().map(blurred).collect()
}

/// Gives every cell that hangs together with a coloured one, across seams too, the mean of its coloured neighbours, ring
/// by ring. Returns how many were filled.
pub fn fill(colours: &mut [Option<[f32; 3]>], atlas: &Atlas) -> u64 {
    let touching =
        |number: u32| atlas.around(number).into_iter().filter(|&n| n != NO_TEXEL).chain(atlas.across(number));
    let is_edge =
        |number: &u32| colours[*number as usize].is_none() && touching(*number).any(|n| colours[n as usize].is_some());
    let mut ring: Vec<u32> = (0..colours.len() as u32).into_par_iter().filter(is_edge).collect();
    let mut filled = 0;
    while !ring.is_empty() {
        let mean_around = |&number: &u32| {
            let mut mean = Mean::default();
            touching(number).filter_map(|n| colours[n as usize].as_ref()).for_each(|colour| mean.add(colour, 1.0));
            mean.take()
        };
        // First all of a ring, then the next: no cell depends on which of its ring came first.
        let found: Vec<Option<[f32; 3]>> = ring.par_iter().map(mean_around).collect();
        for (&number, colour) in ring.iter().zip(found) {
            colours[number as usize] = colour;
        }
        filled += ring.len() as u64;
        let mut next: Vec<u32> =
            ring.iter().flat_map(|&number| touching(number)).filter(|&n| colours[n as usize].is_none()).collect();
        next.sort_unstable();
        next.dedup();
        ring = next;
    }
    filled
}

/// A weighted mean of colours.
#[derive(Default)]
struct Mean {
    sum: [f32; 3],
    weight: f32,
}

impl Mean {
    fn add(&mut self, colour: &[f32; 3], weight: f32) {
        (0..3).for_each(|c| self.sum[c] += weight * colour[c]);
        self.weight += weight;
    }

    fn take(self) -> Option<[f32; 3]> {
        (self.weight > 0.0).then(|| self.sum.map(|s| s / self.weight))
    }
}
