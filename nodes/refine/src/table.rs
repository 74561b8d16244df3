//! The table on which the thing stands: flat, so that strokes which meet nowhere else agree by it.
//!
//! Where a scan is short, parts of the thing are seen once; but the strokes that ran over them have seen the table, too.
//! Its points are the members of one more surfel that is a plane, wherever they lie. Whether it is flat each stripe tells
//! by itself, whatever the pose: on a flat table it is straight.

use crate::cloud::{Cloud, CloudPoint};
use crate::scene::FramePose;
use crate::surfel::{Member, Patch, SurfelMiddle};
use geometry::{Facing, Table, TableSearch};
use nalgebra::{Matrix3, Point3, Vector3};

/// The table speaks when all is right to so much, and to those points alone: before, the foot of the thing is not told
/// from it.
pub(crate) const SCALE_M: f32 = 1e-3;
const SEARCH: TableSearch = TableSearch {
    near_m: 1e-3,
    // Light that grazes is seen as well.
    least_facing: 0.05,
    least_share: 0.08,
    most_behind: 0.03,
    trials: 400,
    looked_at: 1000,
};
/// So many points are looked at.
const POINTS: usize = 10_000;
/// What a point says of the table counts so much beside what it says as a member of a surfel: a plane so large leaves none
/// of it free, and tables are not perfect.
const SHARE: f32 = 0.4;
/// Half of the points of a stripe lie within this of a straight line, on a flat table.
const STRAIGHT_M: f32 = 2e-4;
/// All stripes together rise by no more than this from the middle of 10 cm to their ends: a table, not a large dish.
const BOW_M: f32 = 5e-5;
/// A stripe tells by so many points at least, over this length.
const STRIPE_POINTS: usize = 8;
const STRIPE_M: f32 = 0.02;
/// The plane's own terms are in units of this, so that all are alike in size.
const UNIT_M: f32 = 0.1;

/// A point of the table, in its plane.
struct Lying<'a> {
    point: &'a CloudPoint,
    height_m: f32,
    along: [f32; 2],
}

/// The table's points as one more surfel. `None` where there is no table, or it is not flat.
pub(crate) fn patch(cloud: &Cloud, poses: &[FramePose]) -> Option<Patch> {
    let stride = cloud.points.len().div_ceil(POINTS).max(1);
    let points: Vec<&CloudPoint> = cloud.points.iter().step_by(stride).collect();
    let facing = |p: &&CloudPoint| Facing { position: Point3::from(p.position.cast()), towards: p.to_sensor.cast() };
    let table = Table::find(&points.iter().map(facing).collect::<Vec<_>>(), &SEARCH)?;
    let normal: Vector3<f32> = table.normal.cast();
    let first = if normal.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() };
    let u = normal.cross(&first).normalize();
    let v = normal.cross(&u);
    let lying = |point: &CloudPoint| {
        let height_m = normal.dot(&point.position) - table.distance_m as f32;
        let near = height_m.abs() < 3.0 * SCALE_M && normal.dot(&point.to_sensor) > SEARCH.least_facing as f32;
        near.then(|| (height_m, [u.dot(&point.position), v.dot(&point.position)]))
    };
    let mut lying: Vec<Lying> = points
        .iter()
        .filter_map(|point| lying(point).map(|(height_m, along)| Lying { point, height_m, along }))
        .collect();
    lying.sort_by_key(|lying| (lying.point.frame, lying.point.index));
    is_flat(&lying).then(|| surfel(&lying, poses, &normal))
}

/// How many frames have points on it. Its members are in the order of the frames.
pub(crate) fn frames(table: &Patch) -> usize {
    table.members.chunk_by(|a, b| a.frame == b.frame).count()
}

/// Whether stripes are straight on it: each for itself, and all together not bent one way.
fn is_flat(lying: &[Lying]) -> bool {
    let mut off = Vec::new();
    let (mut bent, mut square) = (0.0, 0.0);
    for stripe in lying.chunk_by(|a, b| a.point.frame == b.point.frame) {
        for (height_m, bow_m, weight) in off_straight(stripe) {
            off.push(height_m.abs());
            bent += weight * height_m * bow_m;
            square += weight * bow_m * bow_m;
        }
    }
    let middle = off.len() / 2;
    let bow = bent / square;
    !off.is_empty()
        && *off.select_nth_unstable_by(middle, f32::total_cmp).1 < STRAIGHT_M
        && bow.abs() < BOW_M / (0.5 * UNIT_M).powi(2)
}

/// A stripe's heights and the squares of its places, both less their own straight line by least squares along its longer
/// direction; and what each point weighs.
fn off_straight(stripe: &[Lying]) -> Vec<(f32, f32, f32)> {
    let ends = |axis: usize| {
        let of = |lying: &Lying| lying.along[axis];
        [stripe.iter().map(of).fold(f32::MAX, f32::min), stripe.iter().map(of).fold(f32::MIN, f32::max)]
    };
    let [x, y] = [ends(0), ends(1)];
    let (axis, [from, to]) = if x[1] - x[0] > y[1] - y[0] { (0, x) } else { (1, y) };
    if stripe.len() < STRIPE_POINTS || to - from < STRIPE_M {
        return Vec::new();
    }
    let place = |lying: &Lying| lying.along[axis] - 0.5 * (from + to);
    let mean = |of: &dyn Fn(&Lying) -> f32| stripe.iter().map(|l| robust(l) * of(l)).sum::<f32>();
    let total = mean(&|_| 1.0);
    let middle = mean(&place) / total;
    let spread = mean(&|l| (place(l) - middle).powi(2));
    let line = |of: &dyn Fn(&Lying) -> f32| [mean(of) / total, mean(&|l| (place(l) - middle) * of(l)) / spread];
    let [height, bow] = [line(&|l| l.height_m), line(&|l| place(l).powi(2))];
    let off = |l: &Lying| {
        let s = place(l) - middle;
        let less = |value: f32, [at, slope]: [f32; 2]| value - at - slope * s;
        (less(l.height_m, height), less(place(l).powi(2), bow), robust(l))
    };
    stripe.iter().map(off).collect()
}

/// Geman and McClure, as for the quadrics.
fn robust(lying: &Lying) -> f32 {
    (SCALE_M.powi(2) / (SCALE_M.powi(2) + lying.height_m.powi(2))).powi(2)
}

/// A plane over all of it: heights, their derivatives by the frames' corrections, and the plane's own three terms whitened as
/// a quadric's are (see `schur`).
fn surfel(lying: &[Lying], poses: &[FramePose], normal: &Vector3<f32>) -> Patch {
    let terms = |lying: &Lying| Vector3::new(1.0, lying.along[0] / UNIT_M, lying.along[1] / UNIT_M);
    let weight = |lying: &Lying| SHARE * robust(lying);
    let sum = |sum: Matrix3<f64>, lying: &Lying| {
        let terms = terms(lying).cast::<f64>();
        sum + terms * terms.transpose() * f64::from(weight(lying))
    };
    let Some(factor) = lying.iter().fold(Matrix3::zeros(), sum).cholesky() else { return Patch::default() };
    let lower: Matrix3<f32> = factor.l().cast();
    let mut patch = Patch::default();
    for lying in lying {
        let root = weight(lying).sqrt();
        let jacobian = poses[lying.point.frame as usize].jacobian(normal, &lying.point.in_body);
        let whitened = lower.solve_lower_triangular(&(terms(lying) * root)).unwrap_or_default();
        let mut member = Member {
            jacobian: jacobian.map(|d| root * d),
            terms: [0.0; 6],
            frame: lying.point.frame,
            residual: root * lying.height_m,
            distance_m: lying.height_m,
            root_weight: root,
        };
        (0..3).for_each(|i| member.terms[i] = whitened[i]);
        patch.members.push(member);
    }
    patch.ends.push(patch.members.len() as u32);
    patch.middles.push(SurfelMiddle { position: Vector3::zeros(), normal: *normal });
    patch
}
