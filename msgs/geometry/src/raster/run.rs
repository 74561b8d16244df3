//! The pixels of one row of a triangle's box, several at a time and without a branch: most are written with what they held.

use wide::{f32x4, i32x4, u32x4};

/// Pixels of a group.
pub(super) const LANES: usize = 4;

/// The next pixels of a row.
pub(super) struct Run {
    /// Edge functions at each, and from one group to the next.
    weights: [i32x4; 3],
    step: [i32x4; 3],
    /// 1/z at each, in 1/m, and from one group to the next.
    inverse_depth: f32x4,
    depth_step: f32x4,
}

impl Run {
    /// Edge functions and 1/z of the first pixel, and from each pixel to the next.
    #[inline]
    pub fn new(weights: [i32; 3], step: [i32; 3], inverse_depth: f32, depth_step: f32) -> Self {
        let lanes = i32x4::new([0, 1, 2, 3]);
        Self {
            weights: [0, 1, 2].map(|k| i32x4::splat(weights[k]) + i32x4::splat(step[k]) * lanes),
            step: step.map(|step| i32x4::splat(step << LANES.trailing_zeros())),
            inverse_depth: f32x4::splat(inverse_depth) + f32x4::splat(depth_step) * lanes.round_float(),
            depth_step: f32x4::splat(depth_step * LANES as f32),
        }
    }

    /// Enters triangle `id` wherever a pixel lies in it and nothing nearer was drawn; both slices have the row's pixels.
    #[inline]
    pub fn fill(mut self, id: u32, depths: &mut [f32], ids: &mut [u32]) {
        let (depths, last_depths) = depths.as_chunks_mut::<LANES>();
        let (ids, last_ids) = ids.as_chunks_mut::<LANES>();
        for (depths, ids) in depths.iter_mut().zip(ids) {
            self.next(id, depths, ids);
        }
        if !last_depths.is_empty() {
            let (mut depths, mut ids) = ([0.0; LANES], [0; LANES]);
            depths[..last_depths.len()].copy_from_slice(last_depths);
            ids[..last_ids.len()].copy_from_slice(last_ids);
            self.next(id, &mut depths, &mut ids);
            last_depths.copy_from_slice(&depths[..last_depths.len()]);
            last_ids.copy_from_slice(&ids[..last_ids.len()]);
        }
    }

    #[inline(always)]
    fn next(&mut self, id: u32, depths: &mut [f32; LANES], ids: &mut [u32; LANES]) {
        let (old, whose) = (f32x4::new(*depths), u32x4::new(*ids));
        let [a, b, c] = self.weights;
        let inside: u32x4 = bytemuck::cast((a | b | c).simd_gt(i32x4::splat(-1)));
        let nearer: u32x4 = bytemuck::cast(self.inverse_depth.simd_gt(old));
        let taken = inside & nearer;
        *depths = bytemuck::cast::<_, f32x4>(taken).select(self.inverse_depth, old).to_array();
        *ids = taken.select(u32x4::splat(id), whose).to_array();
        self.weights = [0, 1, 2].map(|k| self.weights[k] + self.step[k]);
        self.inverse_depth += self.depth_step;
    }
}
