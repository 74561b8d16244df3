//! The data's part of the normal equations with the surfels' own parameters eliminated, never formed as a matrix.
//!
//! A surfel with members i has the cost sum w_i (e_i + J_i d - phi_i c)^2. Minimised over its parameters c it leaves
//! d^T J~^T (I - Psi Psi^T) J~ d with J~ = sqrt(w) J and Psi = sqrt(w) phi L^-T, where L L^T = sum w phi phi^T (+ ridge).
//! Psi^T Psi <= I, so what is left is symmetric and positive semi-definite whatever single precision does to Psi.

use crate::quadric::TERMS;
use crate::surfel::{Member, Patch};
use geometry::sign;
use nalgebra::{Matrix6, Vector6};
use rayon::prelude::*;

/// What each frame's data say of its correction by itself.
#[derive(Debug, Clone)]
pub(crate) struct FrameData {
    /// J^T W (I - leverage) J: the block's diagonal of the eliminated system.
    pub hessian: Matrix6<f64>,
    /// -J^T W e, eliminated.
    pub force: Vector6<f64>,
    /// How many members its points are.
    pub members: u32,
}

impl FrameData {
    /// Of a frame without members.
    pub fn none() -> Self {
        Self { hessian: Matrix6::zeros(), force: Vector6::zeros(), members: 0 }
    }
}

/// Fewer frames are not worth a thread: where others work as well, each hand-over may cost a time slice.
pub(crate) const FRAMES_A_TASK: usize = 2048;

/// The part of the values that the surfel's parameters take up: Psi^T v.
fn taken(members: &[Member], values: &[f32]) -> [f32; TERMS] {
    let mut taken = [0f32; TERMS];
    for (member, value) in members.iter().zip(values) {
        taken.iter_mut().zip(member.terms).for_each(|(taken, term)| *taken += term * value);
    }
    taken
}

fn dot(a: &[f32; 6], b: &[f32; 6]) -> f32 {
    let product: [f32; 6] = std::array::from_fn(|i| a[i] * b[i]);
    (product[0] + product[4]) + (product[1] + product[5]) + (product[2] + product[3])
}

impl Patch {
    /// The members of each surfel.
    pub fn surfels(&self) -> impl Iterator<Item = &[Member]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.members[start as usize..end as usize])
    }

    /// The surfels of which `is_kept` is true.
    pub fn thinned(&self, mut is_kept: impl FnMut() -> bool) -> Self {
        let mut thinned = Self::default();
        for (members, middle) in self.surfels().zip(&self.middles).filter(|_| is_kept()) {
            thinned.members.extend_from_slice(members);
            thinned.ends.push(thinned.members.len() as u32);
            thinned.middles.push(*middle);
        }
        thinned
    }
}

/// Room for the product: one sum for each patch.
pub(crate) struct Room {
    sums: Vec<Vec<[f32; 6]>>,
    moves: Vec<[f32; 6]>,
}

impl Room {
    pub fn new(patches: &[Patch], frames: usize) -> Self {
        let sums = vec![vec![[0.0; 6]; frames]; patches.len()];
        Self { sums, moves: vec![[0.0; 6]; frames] }
    }
}

/// For each frame the force that the data answer to these corrections of all frames: J~^T (I - Psi Psi^T) J~ d, times
/// `weight`.
pub(crate) fn product(
    patches: &[Patch],
    weight: f64,
    corrections: &[Vector6<f64>],
    room: &mut Room,
) -> Vec<Vector6<f64>> {
    for (wide, correction) in room.moves.iter_mut().zip(corrections) {
        (0..6).for_each(|i| wide[i] = correction[i] as f32);
    }
    let moves = &room.moves;
    forces(patches, weight, &mut room.sums, |_, member| dot(&member.jacobian, &moves[member.frame as usize]))
}

/// The forces when every member's distance is moved by 1, this way or that: with the root of a weight their covariance is
/// what [`product`] multiplies by with the weight.
pub(crate) fn shaken(patches: &[Patch], weight: f64, seed: u64, room: &mut Room) -> Vec<Vector6<f64>> {
    forces(patches, weight, &mut room.sums, |index, _| sign(seed, index) as f32)
}

/// J~^T (I - Psi Psi^T) times a value of each member, by its number, times `weight`.
fn forces(
    patches: &[Patch],
    weight: f64,
    room: &mut [Vec<[f32; 6]>],
    value: impl Fn(u64, &Member) -> f32 + Sync,
) -> Vec<Vector6<f64>> {
    patches.par_iter().zip(room.par_iter_mut()).enumerate().for_each(|(number, (patch, sums))| {
        sums.fill([0.0; 6]);
        let mut values = Vec::new();
        let mut index = (number as u64) << 32;
        for members in patch.surfels() {
            values.clear();
            values.extend(members.iter().zip(index..).map(|(member, index)| value(index, member)));
            index += members.len() as u64;
            let taken = taken(members, &values);
            for (member, value) in members.iter().zip(&values) {
                let left = value - dot(&member.terms, &taken);
                let sum = &mut sums[member.frame as usize];
                (0..6).for_each(|i| sum[i] += member.jacobian[i] * left);
            }
        }
    });
    let total = |k: usize| {
        let mut total = Vector6::zeros();
        room.iter().for_each(|sums| (0..6).for_each(|i| total[i] += f64::from(sums[k][i])));
        total * weight
    };
    let frames = room.first().map_or(0, Vec::len);
    (0..frames).into_par_iter().with_min_len(FRAMES_A_TASK).map(total).collect()
}

/// Right side and diagonal blocks, times `weight`.
pub(crate) fn frame_data(patches: &[Patch], weight: f64, frames: usize) -> Vec<FrameData> {
    let none = FrameData::none();
    let parts: Vec<Vec<FrameData>> = patches
        .par_iter()
        .map(|patch| {
            let mut data = vec![none.clone(); frames];
            let mut values = Vec::new();
            for members in patch.surfels() {
                values.clear();
                values.extend(members.iter().map(|m| m.residual));
                let taken = taken(members, &values);
                for (member, value) in members.iter().zip(&values) {
                    let own = &mut data[member.frame as usize];
                    let value = value - dot(&member.terms, &taken);
                    let left = (1.0 - dot(&member.terms, &member.terms)).max(0.0);
                    own.members += 1;
                    for i in 0..6 {
                        own.force[i] -= f64::from(member.jacobian[i] * value);
                        for j in 0..=i {
                            own.hessian[(i, j)] += f64::from(left * member.jacobian[i] * member.jacobian[j]);
                        }
                    }
                }
            }
            data
        })
        .collect();
    let total = |k: usize| {
        let mut sum = none.clone();
        for part in &parts {
            sum.hessian += part[k].hessian;
            sum.force += part[k].force;
            sum.members += part[k].members;
        }
        sum.hessian.fill_upper_triangle_with_lower_triangle();
        FrameData { hessian: sum.hessian * weight, force: sum.force * weight, ..sum }
    };
    (0..frames).into_par_iter().with_min_len(FRAMES_A_TASK).map(total).collect()
}

/// The root mean square of a robust part of the residuals: 1.4826 times their median size, in metres.
pub(crate) fn robust_sigma_m(patches: &[Patch]) -> f64 {
    const SIGMA_PER_MEDIAN: f64 = 1.4826;
    let mut sizes: Vec<f32> =
        patches.iter().flat_map(|patch| &patch.members).map(|member| member.distance_m.abs()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f32::total_cmp);
    SIGMA_PER_MEDIAN * f64::from(*median)
}
