//! What a camera sees of a mesh: z-buffer rasterisation through the real lens (Catmull 1974; edge functions as in Pineda
//! 1988, "A parallel algorithm for polygon rasterization").
//!
//! Vertices are projected with the full distortion and snapped to 1/1024 px, so that the edge functions are exact
//! integers and two triangles leave no gap between them. Between its corners a triangle is flat on the picture, which
//! the lens does not keep; so edges longer than [`LONGEST_EDGE_PX`] are halved until they are not, the same way from
//! both triangles that share one. That bounds the error to a few hundredths of a pixel, and also settles triangles that
//! pass beside or behind the camera.

mod lens;
mod run;

use crate::{Camera, TriangleMesh};
use lens::{Corner, Lens, NOWHERE, SUBPIXEL, SUBPIXEL_BITS};
use nalgebra::{Isometry3, Point3};
use run::{LANES, Run};

/// No triangle at a pixel.
pub const NO_TRIANGLE: u32 = u32::MAX;

/// An edge of at most this length is drawn straight.
pub const LONGEST_EDGE_PX: f32 = 24.0;

/// Halvings of one triangle: enough for one that fills the picture, and an end for one that no scene should hold.
const MOST_HALVINGS: u32 = 50_000;
/// Halvings in a row; 2^16 in each of a triangle's directions.
const DEEPEST: u32 = 32;
/// The nearest triangle at every pixel. Pixel centres are whole numbers.
#[derive(Debug, Clone, Default)]
pub struct VisibilityBuffer {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 1/z in 1/m, row by row; 0 where there is nothing.
    pub inverse_depth: Vec<f32>,
    /// Which triangle, row by row; [`NO_TRIANGLE`] where there is none.
    pub triangle: Vec<u32>,
    /// Leave out triangles seen from behind (for closed surfaces: twice as fast, same picture). Off at first.
    pub cull_back_faces: bool,
    corners: Vec<Corner>,
}

impl VisibilityBuffer {
    /// An empty buffer.
    pub fn new(width: usize, height: usize) -> Self {
        let pixels = width * height;
        Self { width, height, inverse_depth: vec![0.0; pixels], triangle: vec![NO_TRIANGLE; pixels], ..Self::default() }
    }

    /// Forgets what was drawn.
    pub fn clear(&mut self) {
        self.inverse_depth.fill(0.0);
        self.triangle.fill(NO_TRIANGLE);
    }

    /// Depth along the optical axis at a pixel; `None` where nothing was drawn.
    pub fn depth_m(&self, column: usize, row: usize) -> Option<f32> {
        let inverse = *self.inverse_depth.get(row * self.width + column)?;
        (inverse > 0.0).then(|| inverse.recip())
    }

    /// Where vertex `index` of the mesh drawn last lies on the picture, and its 1/z; `None` where the lens cannot show it.
    pub fn projected(&self, index: usize) -> Option<[f32; 3]> {
        let corner = self.corners.get(index).filter(|corner| corner.u != NOWHERE)?;
        const STEP_PX: f32 = 1.0 / SUBPIXEL as f32;
        Some([corner.u as f32 * STEP_PX, corner.v as f32 * STEP_PX, corner.inverse_depth])
    }

    /// Draws a mesh (in world) over what is there. Triangle `i` is entered as `first_triangle + i`. Of two surfaces at
    /// the same depth the first drawn stays.
    pub fn draw(
        &mut self,
        camera: &Camera,
        camera_from_world: &Isometry3<f64>,
        mesh: &TriangleMesh,
        first_triangle: u32,
    ) {
        let lens = Lens::new(camera, camera_from_world);
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        corners.extend(mesh.vertices.iter().map(|p| lens.corner(&lens.in_camera(p))));
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            let [i, j, k] = triangle.map(|i| i as usize);
            let (Some(&a), Some(&b), Some(&c)) = (corners.get(i), corners.get(j), corners.get(k)) else { continue };
            let id = first_triangle + index as u32;
            if is_small(&a, &b, &c) {
                self.fill([a, b, c], id);
            } else {
                let [p, q, r] = [i, j, k].map(|i| lens.in_camera(&mesh.vertices[i]));
                if [p, q, r].iter().all(|p| p.coords.iter().all(|x| x.is_finite())) {
                    self.split(&lens, [(p, a), (q, b), (r, c)], id, DEEPEST, &mut { MOST_HALVINGS });
                }
            }
        }
        self.corners = corners;
    }

    /// Halves the longest edge until all are short.
    fn split(&mut self, lens: &Lens, [a, b, c]: [(Point3<f32>, Corner); 3], id: u32, depth: u32, left: &mut u32) {
        if is_small(&a.1, &b.1, &c.1) {
            return self.fill([a.1, b.1, c.1], id);
        }
        if depth == 0 || *left == 0 || lens.sees_nothing_of([&a.0, &b.0, &c.0], self.width, self.height) {
            return;
        }
        *left -= 1;
        let [ab, bc, ca] = [lens.edge(&a, &b), lens.edge(&b, &c), lens.edge(&c, &a)];
        let (a, b, c) = if ab >= bc && ab >= ca {
            (a, b, c)
        } else if bc >= ca {
            (b, c, a)
        } else {
            (c, a, b)
        };
        // The sum of two numbers does not depend on their order, so the neighbour finds the same middle.
        let middle = Point3::from((a.0.coords + b.0.coords) * 0.5);
        let middle = (middle, lens.corner(&middle));
        self.split(lens, [a, middle, c], id, depth - 1, left);
        self.split(lens, [middle, b, c], id, depth - 1, left);
    }

    /// Fills the pixels whose centres lie in a triangle of short edges.
    fn fill(&mut self, [a, mut b, mut c]: [Corner; 3], id: u32) {
        let mut doubled_area = cross(&a, &b, c.u, c.v);
        // u to the right and v down: what is counter-clockwise from outside turns the other way on the picture.
        if doubled_area == 0 || (self.cull_back_faces && doubled_area > 0) {
            return;
        }
        let last = |size: usize| (size as i32 - 1) * SUBPIXEL;
        let first_u = ceil_pixel(a.u.min(b.u).min(c.u)).max(0);
        let last_u = a.u.max(b.u).max(c.u).min(last(self.width)) >> SUBPIXEL_BITS;
        let first_v = ceil_pixel(a.v.min(b.v).min(c.v)).max(0);
        let last_v = a.v.max(b.v).max(c.v).min(last(self.height)) >> SUBPIXEL_BITS;
        if first_u > last_u || first_v > last_v {
            return;
        }
        if doubled_area < 0 {
            (b, c, doubled_area) = (c, b, -doubled_area);
        }
        // Whole groups of pixels: those beside the triangle's box are not in it either.
        let first_u = first_u & !(LANES as i32 - 1);
        let columns = ((last_u - first_u) as usize + 1).next_multiple_of(LANES).min(self.width - first_u as usize);
        let (u, v) = (first_u << SUBPIXEL_BITS, first_v << SUBPIXEL_BITS);
        let mut row_weights = [cross(&b, &c, u, v), cross(&c, &a, u, v), cross(&a, &b, u, v)];
        let step_u = [b.v - c.v, c.v - a.v, a.v - b.v].map(|d| d << SUBPIXEL_BITS);
        let step_v = [c.u - b.u, a.u - c.u, b.u - a.u].map(|d| d << SUBPIXEL_BITS);
        // 1/z is linear on the picture of a plane.
        let scale = 1.0 / doubled_area as f32;
        let (to_b, to_c) = ((b.inverse_depth - a.inverse_depth) * scale, (c.inverse_depth - a.inverse_depth) * scale);
        let along = |weights: [i32; 3]| to_b * weights[1] as f32 + to_c * weights[2] as f32;
        let (depth_step_u, depth_step_v) = (along(step_u), along(step_v));
        let mut row_depth = a.inverse_depth + along(row_weights);
        let mut start = first_v as usize * self.width + first_u as usize;
        for _ in first_v..=last_v {
            let depths = &mut self.inverse_depth[start..start + columns];
            let ids = &mut self.triangle[start..start + columns];
            Run::new(row_weights, step_u, row_depth, depth_step_u).fill(id, depths, ids);
            row_weights = std::array::from_fn(|i| row_weights[i] + step_v[i]);
            row_depth += depth_step_v;
            start += self.width;
        }
    }
}

/// The first pixel centre at or behind a place.
fn ceil_pixel(place: i32) -> i32 {
    (place + (SUBPIXEL - 1)) >> SUBPIXEL_BITS
}

/// Twice the area of a, b and (u, v): above 0 when they turn from u towards v.
fn cross(a: &Corner, b: &Corner, u: i32, v: i32) -> i32 {
    (b.u - a.u) * (v - a.v) - (b.v - a.v) * (u - a.u)
}

/// All corners on the picture's plane, and all edges short: then no product in `fill` leaves an i32.
fn is_small(a: &Corner, b: &Corner, c: &Corner) -> bool {
    const LONGEST: u32 = (LONGEST_EDGE_PX as i32 * SUBPIXEL) as u32;
    // NOWHERE is so far from everything that it is never short, but from itself.
    let across = a.u.max(b.u).max(c.u).abs_diff(a.u.min(b.u).min(c.u));
    let down = a.v.max(b.v).max(c.v).abs_diff(a.v.min(b.v).min(c.v));
    across <= LONGEST && down <= LONGEST && a.u != NOWHERE
}
