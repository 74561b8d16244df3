//! Where the depth of the surface steps: there a small error of the pose would put the colour of what is in front onto
//! what is behind.
//!
//! On the picture of a plane 1/z is linear, so its second difference shows steps and not slants.

use rayon::prelude::*;

/// What counts as an edge in depth.
#[derive(Debug, Clone, Copy)]
pub struct Edge {
    /// A step in depth from pixel to pixel, beyond what the slant explains.
    pub jump_m: f32,
    /// Pixels around it that are marked.
    pub margin_px: usize,
}

impl Edge {
    /// Writes 1 for each pixel within the margin of an edge, else 0. The picture is `width` pixels wide.
    pub fn mark(&self, inverse_depth: &[f32], width: usize, near_edge: &mut Vec<u8>) {
        let height = inverse_depth.len() / width.max(1);
        let mut edges = vec![0; inverse_depth.len()];
        edges.par_chunks_mut(width.max(1)).enumerate().for_each(|(row, edges)| {
            let line = |row: usize| &inverse_depth[row * width..(row + 1) * width];
            // At the border of the picture a pixel is its own neighbour.
            let (above, here, below) = (line(row.saturating_sub(1)), line(row), line((row + 1).min(height - 1)));
            let step = |a: f32, b: f32, c: f32| (a - b - b + c).abs() > self.jump_m * b * b;
            for column in 0..width {
                let (left, right) = (here[column.saturating_sub(1)], here[(column + 1).min(width - 1)]);
                let b = here[column];
                let inner = |at: usize, last: usize| at > 0 && at < last;
                edges[column] = u8::from(
                    (inner(column, width - 1) && step(left, b, right))
                        || (inner(row, height - 1) && step(above[column], b, below[column])),
                );
            }
        });
        let mut widened = vec![0; edges.len()];
        widened.par_chunks_mut(width.max(1)).zip(edges.par_chunks(width.max(1))).for_each(|(out, row)| {
            widen(out, row, self.margin_px);
        });
        near_edge.clear();
        near_edge.resize(edges.len(), 0);
        near_edge.par_chunks_mut(width.max(1)).enumerate().for_each(|(row, out)| {
            for from in row.saturating_sub(self.margin_px)..(row + self.margin_px + 1).min(height) {
                let line = &widened[from * width..(from + 1) * width];
                out.iter_mut().zip(line).for_each(|(out, edge)| *out |= edge);
            }
        });
    }
}

/// Spreads marks along a row.
fn widen(out: &mut [u8], row: &[u8], margin: usize) {
    out.copy_from_slice(row);
    for shift in 1..=margin.min(row.len().saturating_sub(1)) {
        let kept = row.len() - shift;
        out[shift..].iter_mut().zip(&row[..kept]).for_each(|(out, edge)| *out |= edge);
        out[..kept].iter_mut().zip(&row[shift..]).for_each(|(out, edge)| *out |= edge);
    }
}
