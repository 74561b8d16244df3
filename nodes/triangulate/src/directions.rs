//! Viewing directions v(i, j) over the whole picture, from a table.

use geometry::Camera;
use nalgebra::Point2;

/// The table is made finer until, halfway between its nodes, no direction is farther from the lens model; with what single
/// precision adds it is a thousandth of a pixel.
const MOST_ERROR_PX: f64 = 7e-4;
/// The first table that is tried, in pixels from node to node; straight lenses need no finer one.
const COARSEST_PX: u32 = 32;
/// No table is larger: what is left of the error then is that of a very strong lens.
const MOST_NODES: usize = 1 << 21;
/// Beyond the picture's edge by so many nodes, for peaks at the rim.
const MARGIN: usize = 1;

/// Undistorted x and y of v = (x, y, 1), on a grid over the picture.
#[derive(Debug, Clone)]
pub struct Directions {
    nodes: Vec<[f32; 2]>,
    columns: usize,
    rows: usize,
    step_px: f32,
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
        let mut step = COARSEST_PX;
        loop {
            let table = Self::with_step(camera, step);
            let finer = 4 * table.nodes.len();
            if step == 1 || finer > MOST_NODES || table.error_px(camera) <= MOST_ERROR_PX {
                return table;
            }
            step /= 2;
        }
    }

    fn with_step(camera: &Camera, step: u32) -> Self {
        let count = |pixels: u32| pixels.div_ceil(step) as usize + 2 + 2 * MARGIN;
        let (columns, rows) = (count(camera.width), count(camera.height));
        let place = |index: usize| (index as f64 - MARGIN as f64) * f64::from(step);
        let node = |index: usize| {
            let direction = camera.direction(Point2::new(place(index % columns), place(index / columns)));
            [direction.x as f32, direction.y as f32]
        };
        Self { nodes: (0..columns * rows).map(node).collect(), columns, rows, step_px: step as f32 }
    }

    /// The largest error halfway between nodes, where a bilinear table is worst; infinite where a node has no direction.
    fn error_px(&self, camera: &Camera) -> f64 {
        let step = f64::from(self.step_px);
        let halfway =
            |count: u32| (0..).map(move |i| (f64::from(i) + 0.5) * step).take_while(move |p| *p < f64::from(count));
        let mut worst: f64 = 0.0;
        for v in halfway(camera.height) {
            for u in halfway(camera.width) {
                let exact = camera.direction(Point2::new(u, v));
                let Some(Direction { xy: [x, y], .. }) = self.at(u as f32, v as f32) else { return f64::INFINITY };
                let off = ((f64::from(x) - exact.x) * camera.fx).hypot((f64::from(y) - exact.y) * camera.fy);
                if !off.is_finite() {
                    return f64::INFINITY;
                }
                worst = worst.max(off);
            }
        }
        worst
    }

    /// The direction of a pixel, bilinear between the four nodes around it; `None` off the picture.
    pub fn at(&self, u_px: f32, v_px: f32) -> Option<Direction> {
        let (s, t) = (u_px / self.step_px + MARGIN as f32, v_px / self.step_px + MARGIN as f32);
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
            let per_u = ((1.0 - t) * (b[k] - a[k]) + t * (d[k] - c[k])) / self.step_px;
            [top + t * (bottom - top), per_u, (bottom - top) / self.step_px]
        };
        let ([x, x_per_u, x_per_v], [y, y_per_u, y_per_v]) = (mix(0), mix(1));
        Some(Direction { xy: [x, y], per_u: [x_per_u, y_per_u], per_v: [x_per_v, y_per_v] })
    }
}
