//! Viewing directions v(i, j) over the whole picture, from a table.

use geometry::Camera;
use nalgebra::Point2;

/// Pixels between two nodes of the table. The distortion's second derivative over a step of 8 px moves a direction by
/// less than 1e-3 px for every lens that does not fold (test: `the_table_is_good_to_a_thousandth_of_a_pixel`).
const STEP_PX: f32 = 8.0;
/// Beyond the picture's edge by so many nodes, for peaks at the rim.
const MARGIN: usize = 1;

/// Undistorted x and y of v = (x, y, 1), on a grid over the picture.
#[derive(Debug, Clone)]
pub struct Directions {
    nodes: Vec<[f32; 2]>,
    columns: usize,
    rows: usize,
}

/// A direction and how it changes from pixel to pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// x and y of v = (x, y, 1).
    pub xy: [f32; 2],
    /// Its change for a pixel to the right.
    pub per_u: [f32; 2],
    /// Its change for a pixel down.
    pub per_v: [f32; 2],
}

impl Directions {
    /// Solves the distortion at every node.
    pub fn new(camera: &Camera) -> Self {
        let count = |pixels: u32| (pixels as f32 / STEP_PX).ceil() as usize + 2 + 2 * MARGIN;
        let (columns, rows) = (count(camera.width), count(camera.height));
        let place = |index: usize| f64::from((index as f32 - MARGIN as f32) * STEP_PX);
        let node = |index: usize| {
            let direction = camera.direction(Point2::new(place(index % columns), place(index / columns)));
            [direction.x as f32, direction.y as f32]
        };
        Self { nodes: (0..columns * rows).map(node).collect(), columns, rows }
    }

    /// The direction of a pixel, bilinear between the four nodes around it; `None` off the picture.
    pub fn at(&self, u_px: f32, v_px: f32) -> Option<Direction> {
        let (s, t) = (u_px / STEP_PX + MARGIN as f32, v_px / STEP_PX + MARGIN as f32);
        // Also false for NaN.
        if !(s >= 0.0 && t >= 0.0 && s < (self.columns - 1) as f32 && t < (self.rows - 1) as f32) {
            return None;
        }
        let (i, j) = (s as usize, t as usize);
        let (s, t) = (s - i as f32, t - j as f32);
        let first = j * self.columns + i;
        let (a, b) = (self.nodes[first], self.nodes[first + 1]);
        let (c, d) = (self.nodes[first + self.columns], self.nodes[first + self.columns + 1]);
        let mix = |k: usize| {
            let (top, bottom) = (a[k] + s * (b[k] - a[k]), c[k] + s * (d[k] - c[k]));
            let per_u = ((1.0 - t) * (b[k] - a[k]) + t * (d[k] - c[k])) / STEP_PX;
            [top + t * (bottom - top), per_u, (bottom - top) / STEP_PX]
        };
        let ([x, x_per_u, x_per_v], [y, y_per_u, y_per_v]) = (mix(0), mix(1));
        Some(Direction { xy: [x, y], per_u: [x_per_u, y_per_u], per_v: [x_per_v, y_per_v] })
    }
}
