//! What hides what from the camera: the depth of the surface at each pixel.

use crate::edge::Edge;
use geometry::{Camera, TriangleMesh, VisibilityBuffer};
use nalgebra::{Isometry3, Point3};
use rayon::prelude::*;

/// A part of the surface has at most so many triangles: small enough that most parts beside the view are left out.
const PART_TRIANGLES: usize = 2048;

/// A compact part of the surface in a ball.
#[derive(Debug, Clone)]
struct Part {
    mesh: TriangleMesh,
    centre: Point3<f32>,
    radius_m: f32,
}

/// The surface in parts, and buffers to draw them into.
#[derive(Debug, Clone, Default)]
pub struct Occlusion {
    parts: Vec<Part>,
    buffers: Vec<VisibilityBuffer>,
    /// 1/z in 1/m of the nearest surface at each pixel, row by row; 0 where there is none.
    pub inverse_depth: Vec<f32>,
    /// 1 for a pixel that is too near to an edge in depth.
    pub near_edge: Vec<u8>,
}

impl Occlusion {
    /// Prepares a surface.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let mut order: Vec<(Point3<f32>, u32)> =
            (0..mesh.triangles.len()).map(|t| (middle(mesh, t), t as u32)).collect();
        let mut parts = Vec::new();
        split(&mut order, mesh, &mut parts);
        Self { parts, ..Self::default() }
    }

    /// Sees the surface through a camera: fills `inverse_depth` and `near_edge`. Parts beyond `view_rad` of the optical
    /// axis are left out. The largest 1/z does not depend on who draws what, so any number of threads gives the same.
    pub fn see(&mut self, camera: &Camera, camera_from_world: &Isometry3<f64>, view_rad: f64, edge: &Edge) {
        let (width, height) = (camera.width as usize, camera.height as usize);
        let seen: Vec<&Part> =
            self.parts.iter().filter(|part| part.is_in_view(camera_from_world, view_rad as f32)).collect();
        let workers = rayon::current_num_threads().clamp(1, 8);
        if self.buffers.len() != workers || self.buffers.iter().any(|b| (b.width, b.height) != (width, height)) {
            self.buffers = vec![VisibilityBuffer::new(width, height); workers];
        }
        self.buffers.par_iter_mut().enumerate().for_each(|(worker, buffer)| {
            buffer.clear();
            for part in seen.iter().skip(worker).step_by(workers) {
                buffer.draw(camera, camera_from_world, &part.mesh, 0);
            }
        });
        self.inverse_depth.clear();
        self.inverse_depth.extend_from_slice(&self.buffers[0].inverse_depth);
        for buffer in &self.buffers[1..] {
            self.inverse_depth.iter_mut().zip(&buffer.inverse_depth).for_each(|(all, one)| *all = all.max(*one));
        }
        edge.mark(&self.inverse_depth, width, &mut self.near_edge);
    }
}

impl Part {
    fn is_in_view(&self, camera_from_world: &Isometry3<f64>, view_rad: f32) -> bool {
        let centre = (camera_from_world.cast::<f32>() * self.centre).coords;
        let distance = centre.norm();
        distance <= self.radius_m || {
            let off_axis = centre.x.hypot(centre.y).atan2(centre.z);
            off_axis <= view_rad + (self.radius_m / distance).min(1.0).asin()
        }
    }
}

fn middle(mesh: &TriangleMesh, triangle: usize) -> Point3<f32> {
    let [a, b, c] = mesh.corners(triangle);
    Point3::from((a.coords + b.coords + c.coords) / 3.0)
}

/// Halves the triangles across their longest extent until the parts are small.
fn split(order: &mut [(Point3<f32>, u32)], mesh: &TriangleMesh, parts: &mut Vec<Part>) {
    if order.len() <= PART_TRIANGLES {
        parts.extend(part(order, mesh));
        return;
    }
    let first = order[0].0;
    let (low, high) = order.iter().fold((first, first), |(low, high), (p, _)| (low.inf(p), high.sup(p)));
    let axis = (high - low).imax();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |a, b| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1)));
    let (near, far) = order.split_at_mut(half);
    split(near, mesh, parts);
    split(far, mesh, parts);
}

fn part(order: &[(Point3<f32>, u32)], mesh: &TriangleMesh) -> Option<Part> {
    let mut own: Vec<u32> = order.iter().flat_map(|(_, t)| mesh.triangles[*t as usize]).collect();
    own.sort_unstable();
    own.dedup();
    let place = |i: u32| own.partition_point(|&o| o < i) as u32;
    let mesh = TriangleMesh {
        triangles: order.iter().map(|(_, t)| mesh.triangles[*t as usize].map(place)).collect(),
        vertices: own.iter().map(|&i| mesh.vertices[i as usize]).collect(),
        ..TriangleMesh::default()
    };
    let [low, high] = mesh.bounds()?;
    let centre = nalgebra::center(&low, &high);
    let radius_m = mesh.vertices.iter().map(|p| (p - centre).norm()).fold(0.0, f32::max);
    Some(Part { mesh, centre, radius_m })
}
