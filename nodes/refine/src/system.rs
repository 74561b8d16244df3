//! The normal equations of one look, (P + data) x = b, as a product that is never formed as a matrix.

use crate::pcg;
use crate::precondition::Preconditioner;
use crate::prior::Prior;
use crate::scene::{FramePose, Problem};
use crate::schur::{FRAMES_A_TASK, Room, product, shaken};
use crate::step::Seen;
use crate::unknowns::{Free, Row, Unknowns};
use geometry::word;
use nalgebra::Vector6;
use rayon::prelude::*;

/// What was seen at one set of poses, and what is believed; `free` unknowns may move.
pub(crate) struct System<'a> {
    unknowns: &'a Unknowns,
    prior: &'a Prior,
    pub seen: &'a Seen,
    free: &'a Free,
    rows: Vec<&'a Row>,
    preconditioner: Preconditioner,
}

const TOLERANCE: f64 = 1e-3;

impl<'a> System<'a> {
    pub fn new(problem: &'a Problem, prior: &'a Prior, seen: &'a Seen, free: &'a Free, poses: &'a [FramePose]) -> Self {
        let unknowns = &problem.unknowns;
        let rows: Vec<&Row> = poses.iter().map(|pose| &pose.row).collect();
        let preconditioner = Preconditioner::new(unknowns, free, &rows, &seen.frames, prior);
        Self { unknowns, prior, seen, free, rows, preconditioner }
    }

    /// How many frames there are.
    pub fn frames(&self) -> usize {
        self.rows.len()
    }

    /// P v.
    pub fn believed(&self, v: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; v.len()];
        self.prior.add_product(self.unknowns, self.free, v, &mut out);
        out
    }

    /// The transpose of [`System::corrections`]: adds the forces on the frames' corrections to those on the unknowns.
    pub fn spread<'f>(&self, forces: impl Iterator<Item = &'f Vector6<f64>>, out: &mut [f64]) {
        self.rows.iter().zip(forces).for_each(|(row, force)| self.unknowns.spread(row, force, self.free, out));
    }

    /// What a change of the unknowns does to each frame.
    pub fn corrections(&self, v: &[f64]) -> Vec<Vector6<f64>> {
        let rows = self.rows.par_iter().with_min_len(FRAMES_A_TASK);
        rows.map(|row| self.unknowns.correction(row, v, true)).collect()
    }

    /// A right side as it would be if all were right: what is believed and what the members say, each moved by one
    /// standard deviation. Members are as good as `information_m2` says, whatever weight they have in the solution.
    pub fn shaken(&self, information_m2: f64, seed: u64) -> Vec<f64> {
        let mut room = Room::new(&self.seen.patches, self.rows.len());
        let mut out = self.prior.shaken(self.unknowns, self.free, seed);
        let weight = self.seen.weight / information_m2.sqrt();
        let forces = shaken(&self.seen.patches, weight, word(seed, u64::MAX), &mut room);
        self.spread(forces.iter(), &mut out);
        out
    }

    /// x, after at most so many steps; `None` when it is not finite.
    pub fn solve(&self, b: &[f64], most_steps: usize) -> Option<Vec<f64>> {
        let mut room = Room::new(&self.seen.patches, self.rows.len());
        let apply = |v: &[f64]| {
            let data = || product(&self.seen.patches, self.seen.weight, &self.corrections(v), &mut room);
            let (forces, mut out) = rayon::join(data, || self.believed(v));
            self.spread(forces.iter(), &mut out);
            out
        };
        let precondition = |residual: &[f64]| self.preconditioner.apply(self.unknowns, residual);
        pcg::solve(b, most_steps, TOLERANCE, apply, precondition)
    }
}
