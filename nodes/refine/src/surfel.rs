//! Small pieces of surface, each seen by many frames, and how far each point is from its own.
//!
//! A surfel is a quadric in the frame of its tangent plane. What is kept of it is what the solver needs: for each member
//! point the derivative of its distance by its frame's correction, and the whitened terms of the quadric, by which the
//! surfel's own parameters are eliminated (see `schur`).

use crate::cloud::{Cloud, CloudPoint, cell};
use crate::quadric::{Local, TERMS, fit, plane};
use crate::scene::FramePose;
use geometry::word;
use nalgebra::Vector3;
use rayon::prelude::*;

/// A point of a surfel. All scaled by the root of its weight. 64 bytes: the solver's time goes into reading them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Member {
    /// d distance / d correction of the frame.
    pub jacobian: [f32; 6],
    /// L^-1 phi: the quadric's terms, whitened.
    pub terms: [f32; TERMS],
    /// Which of the placed frames.
    pub frame: u32,
    /// Distance from the quadric, positive towards the viewer; scaled like the rest.
    pub residual: f32,
    /// The same in metres, as it is.
    pub distance_m: f32,
    /// The root by which it was scaled, without the data's common weight.
    pub root_weight: f32,
}

/// Surfels of one part of space.
#[derive(Debug, Clone, Default)]
pub(crate) struct Patch {
    pub members: Vec<Member>,
    /// Behind the last member of each surfel.
    pub ends: Vec<u32>,
    pub middles: Vec<SurfelMiddle>,
}

/// Where a surfel is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfelMiddle {
    pub position: Vector3<f32>,
    pub normal: Vector3<f32>,
}

/// How surfels are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SurfelPlan {
    pub radius_m: f32,
    /// Surfels are about so far apart.
    pub spacing_m: f32,
    pub most_members: usize,
    /// Scale of the robust function.
    pub scale_m: f32,
    pub seed: u64,
}

/// The number of patches does not depend on the machine: sums over patches are in a fixed order.
pub(crate) const PATCHES: usize = 8;
const FEWEST_MEMBERS: usize = 12;
/// A neighbourhood whose middle direction is shorter than this (of the radius, squared) is a line.
const LINE: f32 = 0.01;
/// The thickness above which, and the slant beyond which, the plane's normal is not believed but the viewer's direction.
const THICK: f32 = 0.5;
const SLANTED: f32 = 0.25;

/// All surfels of a cloud.
pub(crate) fn build(cloud: &Cloud, poses: &[FramePose], plan: &SurfelPlan) -> Vec<Patch> {
    let seeds = seeds(cloud, plan);
    let size = seeds.len().div_ceil(PATCHES).max(1);
    // Many small tasks, so that cores end together; the patches are put together in order.
    const TASKS: usize = 8;
    let pieces: Vec<Vec<Patch>> = seeds
        .par_chunks(size)
        .map(|seeds| {
            let task = seeds.len().div_ceil(TASKS).max(1);
            seeds.par_chunks(task).map(|seeds| piece(cloud, poses, plan, seeds)).collect()
        })
        .collect();
    pieces.into_iter().map(joined).collect()
}

fn joined(pieces: Vec<Patch>) -> Patch {
    let mut whole = Patch::default();
    for piece in pieces {
        let before = whole.members.len() as u32;
        whole.members.extend(piece.members);
        whole.ends.extend(piece.ends.iter().map(|end| end + before));
        whole.middles.extend(piece.middles);
    }
    whole
}

fn piece(cloud: &Cloud, poses: &[FramePose], plan: &SurfelPlan, seeds: &[u32]) -> Patch {
    let mut patch = Patch::default();
    let (mut near, mut local) = (Vec::new(), Vec::new());
    for &seed in seeds {
        neighbours(cloud, &cloud.points[seed as usize], plan, &mut near);
        if near.len() >= FEWEST_MEMBERS {
            surfel(cloud, poses, plan, seed, &near, &mut local, &mut patch);
        }
    }
    patch
}

/// One point in each voxel of the spacing and each direction from which it was seen; the voxels lie elsewhere each time.
fn seeds(cloud: &Cloud, plan: &SurfelPlan) -> Vec<u32> {
    let shift = Vector3::from_fn(|axis, _| (word(plan.seed, axis as u64) >> 40) as f32 / (1u64 << 24) as f32);
    let key = |(i, point): (usize, &CloudPoint)| {
        let voxel = cell(&(point.position + shift * plan.spacing_m), plan.spacing_m);
        let v = point.to_sensor;
        let axis = v.iamax();
        let side = 2 * axis as u8 + u8::from(v[axis] < 0.0);
        (voxel, side, word(plan.seed, u64::from(point.index)), i as u32)
    };
    let mut keys: Vec<_> = cloud.points.par_iter().enumerate().map(key).collect();
    keys.par_sort_unstable();
    keys.dedup_by_key(|&mut (voxel, side, ..)| (voxel, side));
    keys.into_iter().map(|(.., i)| i).collect()
}

/// The points within the radius that were seen from the same side, at most so many, picked evenly.
fn neighbours(cloud: &Cloud, seed: &CloudPoint, plan: &SurfelPlan, near: &mut Vec<u32>) {
    near.clear();
    let square = plan.radius_m * plan.radius_m;
    for run in cloud.around(&seed.position) {
        for i in run {
            let point = &cloud.points[i];
            let off = point.position - seed.position;
            if off.norm_squared() < square && point.to_sensor.dot(&seed.to_sensor) > 0.0 {
                near.push(i as u32);
            }
        }
    }
    let (count, most) = (near.len(), plan.most_members);
    if count > most {
        let start = (word(plan.seed ^ 0x5eed, u64::from(seed.index)) >> 32) as usize % count;
        for k in 0..most {
            // Ascending places, so nothing is overwritten before it is read.
            near[k] = near[(k * count + start * most / count.max(1)) / most];
        }
        near.truncate(most);
    }
}

fn surfel(
    cloud: &Cloud,
    poses: &[FramePose],
    plan: &SurfelPlan,
    seed: u32,
    near: &[u32],
    local: &mut Vec<Local>,
    patch: &mut Patch,
) {
    let centre = cloud.points[seed as usize].position;
    let square = plan.radius_m * plan.radius_m;
    let of_distance = |p: &CloudPoint| (1.0 - (p.position - centre).norm_squared() / square).powi(2);
    let points = near.iter().map(|&i| &cloud.points[i as usize]);
    let weighted = points.clone().map(|p| (p.position - centre, of_distance(p)));
    let tangent = plane(weighted);
    if tangent.second.is_nan() || tangent.second < LINE * square {
        return;
    }
    let viewer: Vector3<f32> = points.clone().map(|p| p.to_sensor).sum::<Vector3<f32>>().normalize();
    let facing = tangent.normal.dot(&viewer);
    let normal = match facing.abs() < SLANTED || tangent.flatness > THICK {
        true => viewer,
        false => tangent.normal * facing.signum(),
    };
    let first = if normal.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() };
    let u = normal.cross(&first).normalize();
    let v = normal.cross(&u);
    local.clear();
    local.extend(points.clone().map(|point| {
        let off = point.position - centre;
        let [s, t] = [u.dot(&off) / plan.radius_m, v.dot(&off) / plan.radius_m];
        let terms = [1.0, s, t, s * s, s * t, t * t];
        Local { terms, height: normal.dot(&off), weight: of_distance(point), residual: 0.0, robust: 0.0 }
    }));
    let coarse = (2.0 * plan.scale_m).max(0.25 * plan.radius_m);
    let Some(quadric) = fit(local, plan.radius_m, &[coarse, plan.scale_m, plan.scale_m]) else { return };
    let c = quadric.coefficients;
    for (point, local) in points.zip(local.iter()) {
        let [_, s, t, ..] = local.terms;
        let slope = [c[1] + 2.0 * c[3] * s + c[4] * t, c[2] + c[4] * s + 2.0 * c[5] * t].map(|x| x / plan.radius_m);
        let across = (normal - u * slope[0] - v * slope[1]) * quadric.to_distance;
        let root = local.robust.sqrt();
        let jacobian = poses[point.frame as usize].jacobian(&across, &point.in_body);
        let mut member = Member {
            jacobian: jacobian.map(|d| root * d),
            terms: [0.0; TERMS],
            frame: point.frame,
            residual: root * local.residual,
            distance_m: local.residual,
            root_weight: root,
        };
        for i in 0..TERMS {
            let before: f32 = (0..i).map(|k| quadric.factor[(i, k)] * member.terms[k]).sum();
            member.terms[i] = (root * local.terms[i] - before) / quadric.factor[(i, i)];
        }
        patch.members.push(member);
    }
    patch.ends.push(patch.members.len() as u32);
    patch.middles.push(SurfelMiddle { position: centre, normal });
}
