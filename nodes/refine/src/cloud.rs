//! A random part of the points in the world, sorted into the cells of a grid.

use crate::scene::{FramePose, Problem};
use geometry::uniform;
use nalgebra::Vector3;
use rayon::prelude::*;

/// A point as the surfels see it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CloudPoint {
    /// Relative to the solver's origin.
    pub position: Vector3<f32>,
    /// Unit vector to the camera.
    pub to_sensor: Vector3<f32>,
    /// On the handset.
    pub in_body: Vector3<f32>,
    /// Which of the placed frames.
    pub frame: u32,
    /// Which of the gathered points.
    pub index: u32,
}

/// Points in the order of their cells, so that a neighbourhood is a few runs of them.
pub(crate) struct Cloud {
    pub points: Vec<CloudPoint>,
    /// The cell of each point, ascending: z, y, x from high bits to low.
    cells: Vec<u64>,
    pub cell_m: f32,
    /// Of all points.
    pub share: f64,
}

const BITS: u32 = 21;
const MIDDLE: i64 = 1 << (BITS - 1);

impl Cloud {
    /// About `count` points, chosen by `seed`, at these poses; cells are as large as the neighbourhoods asked for later.
    pub fn sample(problem: &Problem, poses: &[FramePose], count: usize, cell_m: f32, seed: u64) -> Self {
        let gathered = &problem.gathered.frames;
        let all: usize = problem.frames.iter().map(|placed| gathered[placed.frame].points.len()).sum();
        let share = (count as f64 / all.max(1) as f64).min(1.0);
        let chosen = |(k, (frame, pose)): (usize, (&crate::scene::Placed, &FramePose))| {
            let (first, points) = (gathered[frame.frame].first, &gathered[frame.frame].points);
            // A random start and an even stride: every part of every stripe is there.
            let (stride, start) = (1.0 / share, uniform(seed, k as u64));
            let mut found = Vec::with_capacity((points.len() as f64 * share) as usize + 1);
            let mut at = start * stride;
            while (at as usize) < points.len() {
                let index = at as usize;
                let point = &points[index];
                let ray = pose.camera_rotation * Vector3::from(point.position_m);
                found.push(CloudPoint {
                    position: ray + pose.camera_origin,
                    to_sensor: -ray / ray.norm(),
                    in_body: problem.in_body(&point.position_m).cast(),
                    frame: k as u32,
                    index: (first + index) as u32,
                });
                at += stride;
            }
            found
        };
        let frames: Vec<_> = problem.frames.iter().zip(poses).enumerate().collect();
        let points: Vec<CloudPoint> = frames.into_par_iter().flat_map_iter(chosen).collect();
        let mut order: Vec<(u64, u32)> =
            points.par_iter().enumerate().map(|(i, point)| (cell(&point.position, cell_m), i as u32)).collect();
        order.par_sort_unstable();
        Self {
            points: order.iter().map(|&(_, i)| points[i as usize]).collect(),
            cells: order.iter().map(|&(cell, _)| cell).collect(),
            cell_m,
            share,
        }
    }

    /// The runs of points in the 27 cells around a place.
    pub fn around(&self, place: &Vector3<f32>) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        let [x, y, z] = coordinates(place, self.cell_m);
        let rows = (-1..=1).flat_map(move |dz| (-1..=1).map(move |dy| (y + dy, z + dz)));
        rows.map(move |(y, z)| {
            let (from, to) = (pack([x - 1, y, z]), pack([x + 1, y, z]));
            let start = self.cells.partition_point(|&cell| cell < from);
            let end = start + self.cells[start..].partition_point(|&cell| cell <= to);
            start..end
        })
    }
}

/// The cell of a place, as one number.
pub(crate) fn cell(place: &Vector3<f32>, size_m: f32) -> u64 {
    pack(coordinates(place, size_m))
}

fn coordinates(place: &Vector3<f32>, size_m: f32) -> [i64; 3] {
    // What a hostile scan throws far away shares the outermost cells.
    [place.x, place.y, place.z].map(|x| ((x / size_m).floor() as i64).clamp(-MIDDLE, MIDDLE))
}

fn pack(cell: [i64; 3]) -> u64 {
    let [x, y, z] = cell.map(|c| (c + MIDDLE).clamp(0, 2 * MIDDLE - 1) as u64);
    z << (2 * BITS) | y << BITS | x
}
