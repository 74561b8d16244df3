//! One step of all views at once.
//!
//! View by view, each gives way to the others, and they to it: an error that many share, as that of one side of the thing,
//! hardly moves. Together it does. All corrections, the gains going along, are one Gauss-Newton problem, from which what
//! the views agree on for each point is eliminated (Schur; every view is held against their mean), solved by conjugate
//! gradients, never written down, with the views' own blocks as preconditioner.

use crate::settle::consensus::Witnesses;
use crate::settle::view::View;
use nalgebra::{Cholesky, Const, Matrix3, SMatrix, SVector, Vector3, Vector6};
use rayon::prelude::*;

/// A view's correction, and its gain.
pub type Unknowns = SVector<f64, 9>;

/// What a view says of one of its points, and how that changes.
#[derive(Debug, Clone, Copy)]
pub struct Slot {
    /// The point in the camera's frame, where the view has it: metres.
    pub p_in_camera: Vector3<f32>,
    /// How each channel changes with that.
    pub slopes: [Vector3<f32>; 3],
    /// What all say: the gain multiplies it.
    pub agreed: [f32; 3],
    /// What the view says less what all say, by the gain it has.
    pub difference: [f32; 3],
    /// How much that counts; 0 where it says nothing.
    pub weight: f32,
}

impl Slot {
    /// A place where a view says nothing.
    pub const SILENT: Self = Self {
        p_in_camera: Vector3::new(0.0, 0.0, 1.0),
        slopes: [Vector3::new(0.0, 0.0, 0.0); 3],
        agreed: [0.0; 3],
        difference: [0.0; 3],
        weight: 0.0,
    };

    /// The gain is the same all over the picture, or changes evenly across it.
    fn place(&self) -> Vector3<f32> {
        self.p_in_camera / self.p_in_camera.z
    }

    fn change(&self, by: &SVector<f32, 9>) -> [f32; 3] {
        let part = |first| Vector3::from(by.fixed_rows::<3>(first));
        let moved = part(0) + part(3).cross(&self.p_in_camera);
        let gain = self.place().dot(&Vector3::new(by[7], by[8], by[6]));
        std::array::from_fn(|c| self.slopes[c].dot(&moved) - self.agreed[c] * gain)
    }

    /// What pulls of the three channels pull on the unknowns.
    fn pull(&self, on: [f32; 3]) -> SVector<f32, 9> {
        let moved: Vector3<f32> = self.slopes.iter().zip(on).map(|(slope, on)| slope * on).sum();
        let turned = self.p_in_camera.cross(&moved);
        let gain = -self.place() * self.agreed.iter().zip(on).map(|(agreed, on)| agreed * on).sum::<f32>();
        SVector::from([moved.x, moved.y, moved.z, turned.x, turned.y, turned.z, gain.z, gain.x, gain.y])
    }
}

/// The linear problem, as all views stand.
pub struct Together<'a> {
    pub views: &'a [View],
    pub witnesses: &'a Witnesses,
    /// For each view, in the order of what it sees.
    pub slots: Vec<Vec<Slot>>,
    /// Of each unknown, by its prior.
    pub precision: Unknowns,
    /// The gain that each view has.
    pub gains: Vec<Vector3<f64>>,
}

/// Conjugate gradients end at this share of the residual they began with, or after so many steps.
const TOLERANCE: f64 = 1e-2;
const STEPS_MAX: usize = 50;

impl Together<'_> {
    /// Gives all views of a point the same slope along the surface, the mean of theirs. While they disagree on where a
    /// border lies they have their slopes at different sides of it, and hold each other fast. `normals` are those of the
    /// points, in the world.
    pub fn share_slopes(&mut self, normals: &[Vector3<f32>]) {
        let turns: Vec<Matrix3<f32>> = self.views.iter().map(|view| view.turn().cast()).collect();
        let shared: [Vec<[f32; 3]>; 3] = std::array::from_fn(|c| {
            self.witnesses.means(|view, at| {
                let slot = &self.slots[view][at];
                let normal = normals[self.views[view].seen[at].point as usize];
                let slope = turns[view].tr_mul(&slot.slopes[c]);
                ((slope - normal * normal.dot(&slope)).into(), slot.weight)
            })
        });
        let share = |((slots, view), turn): ((&mut Vec<Slot>, &View), &Matrix3<f32>)| {
            for (slot, seen) in slots.iter_mut().zip(&view.seen) {
                let point = seen.point as usize;
                let (normal, ray) = (turn * normals[point], slot.p_in_camera);
                for (slope, shared) in slot.slopes.iter_mut().zip(&shared) {
                    // Along the ray nothing changes.
                    let along = turn * Vector3::from(shared[point]);
                    *slope = along - normal * (along.dot(&ray) / normal.dot(&ray).min(-1e-3 * ray.norm()));
                }
            }
        };
        self.slots.par_iter_mut().zip(self.views).zip(&turns).for_each(share);
    }

    /// How each view's correction is to change.
    pub fn step(&self) -> Vec<Vector6<f64>> {
        let differences: Vec<Vec<[f32; 3]>> =
            self.slots.par_iter().map(|slots| slots.iter().map(|slot| slot.difference).collect()).collect();
        let stands = self.views.iter().zip(&self.gains).map(|(view, gain)| stacked(&view.correction, gain));
        let held = stands.zip(self.gathered(&differences));
        let right: Vec<Unknowns> = held.map(|(at, data)| -data - self.precision.component_mul(&at)).collect();
        let blocks: Vec<_> = self.slots.par_iter().map(|slots| self.block(slots)).collect();
        self.solved(right, &blocks).iter().map(|step| step.fixed_rows::<6>(0).into_owned()).collect()
    }

    /// Preconditioned conjugate gradients (Hestenes & Stiefel 1952).
    fn solved(&self, right: Vec<Unknowns>, blocks: &[Option<Block>]) -> Vec<Unknowns> {
        let eased = |residual: &[Unknowns]| -> Vec<Unknowns> {
            residual
                .iter()
                .zip(blocks)
                .map(|(r, block)| block.as_ref().map_or(Unknowns::zeros(), |b| b.solve(r)))
                .collect()
        };
        let mut solution = vec![Unknowns::zeros(); right.len()];
        let mut residual = right;
        let mut eased_residual = eased(&residual);
        let mut towards = eased_residual.clone();
        let mut size = dot(&residual, &eased_residual);
        let small = TOLERANCE.powi(2) * size;
        for _ in 0..STEPS_MAX {
            if size <= small {
                break;
            }
            let product = self.product(&towards);
            let along = size / dot(&towards, &product);
            if !along.is_finite() {
                break;
            }
            for i in 0..solution.len() {
                solution[i] += towards[i] * along;
                residual[i] -= product[i] * along;
            }
            eased_residual = eased(&residual);
            let next = dot(&residual, &eased_residual);
            for (towards, eased) in towards.iter_mut().zip(&eased_residual) {
                *towards = eased + *towards * (next / size);
            }
            size = next;
        }
        solution
    }

    fn product(&self, unknowns: &[Unknowns]) -> Vec<Unknowns> {
        let change = |(slots, by): (&Vec<Slot>, &Unknowns)| {
            let by = by.cast();
            slots.iter().map(|slot| slot.change(&by)).collect()
        };
        let changes: Vec<Vec<[f32; 3]>> = self.slots.par_iter().zip(unknowns).map(change).collect();
        let data = self.gathered(&changes);
        unknowns.iter().zip(data).map(|(by, data)| data + self.precision.component_mul(by)).collect()
    }

    /// What each view's values, less the mean over the views at each point, are as a slope of the whole.
    fn gathered(&self, values: &[Vec<[f32; 3]>]) -> Vec<Unknowns> {
        let means = self.witnesses.means(|view, at| (values[view][at], self.slots[view][at].weight));
        let gather = |((view, slots), values): ((&View, &Vec<Slot>), &Vec<[f32; 3]>)| {
            let mut sum = SVector::<f32, 9>::zeros();
            let mut total = Unknowns::zeros();
            for (at, ((seen, slot), value)) in view.seen.iter().zip(slots).zip(values).enumerate() {
                let mean = &means[seen.point as usize];
                sum += slot.pull(std::array::from_fn(|c| slot.weight * (value[c] - mean[c])));
                // f32 adds up a few, f64 all.
                if at % 32 == 31 {
                    total += std::mem::take(&mut sum).cast::<f64>();
                }
            }
            total + sum.cast::<f64>()
        };
        self.views.par_iter().zip(&self.slots).zip(values).map(gather).collect()
    }

    /// A view's own part of the problem.
    fn block(&self, slots: &[Slot]) -> Option<Block> {
        let mut normal = SMatrix::<f64, 9, 9>::from_diagonal(&self.precision);
        for slot in slots.iter().filter(|slot| slot.weight > 0.0) {
            for channel in 0..3 {
                let mut on = [0.0; 3];
                on[channel] = 1.0;
                let slope = slot.pull(on).cast::<f64>();
                normal += slope * slope.transpose() * f64::from(slot.weight);
            }
        }
        normal.cholesky()
    }
}

type Block = Cholesky<f64, Const<9>>;

fn stacked(correction: &Vector6<f64>, gain: &Vector3<f64>) -> Unknowns {
    Unknowns::from_fn(|i, _| if i < 6 { correction[i] } else { gain[i - 6] })
}

fn dot(a: &[Unknowns], b: &[Unknowns]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
