//! Preconditioner: each block of unknowns solved by itself, with the diagonal blocks of the data.

use crate::banded::{Banded, Factor};
use crate::prior::Prior;
use crate::schur::FrameData;
use crate::unknowns::{Free, GLOBALS, Row, SPLINES, Unknowns};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;

/// The factored blocks; those that are not free are `None`.
pub(crate) struct Preconditioner {
    splines: Vec<Option<Factor>>,
    globals: Option<Cholesky<f64, Dyn>>,
}

/// Levenberg and Marquardt's damping, here alone.
const DAMPING: f64 = 1e-3;
/// Four knots of six unknowns act on a frame.
const HALF_BANDWIDTH: usize = 23;

impl Preconditioner {
    pub fn new(unknowns: &Unknowns, free: &Free, rows: &[&Row], data: &[FrameData], prior: &Prior) -> Self {
        let spline = |which: usize| {
            let mut band = spline_block(unknowns, which, rows, data, prior);
            band.damp(DAMPING);
            band.factor()
        };
        let (splines, globals) = rayon::join(
            || (0..SPLINES).into_par_iter().map(|which| free.splines[which].then(|| spline(which))).collect(),
            || globals(unknowns, free, rows, data, prior),
        );
        Self { splines, globals }
    }

    /// The residual, made into a step.
    pub fn apply(&self, unknowns: &Unknowns, residual: &[f64]) -> Vec<f64> {
        let mut out = residual.to_vec();
        let (splines, globals) = out.split_at_mut(unknowns.globals().start);
        let mut rest = splines;
        let blocks = self.splines.iter().enumerate().map(|(which, factor)| {
            let (block, behind) = std::mem::take(&mut rest).split_at_mut(unknowns.spline(which).len());
            rest = behind;
            (factor, block)
        });
        let blocks: Vec<_> = blocks.collect();
        blocks.into_par_iter().for_each(|(factor, block)| {
            if let Some(factor) = factor {
                factor.solve(block);
            }
        });
        if let Some(cholesky) = &self.globals {
            let mut right = DVector::from_column_slice(globals);
            cholesky.solve_mut(&mut right);
            globals.copy_from_slice(right.as_slice());
        }
        out
    }
}

/// Data and prior of one spline, all else held fast.
pub(crate) fn spline_block(
    unknowns: &Unknowns,
    which: usize,
    rows: &[&Row],
    data: &[FrameData],
    prior: &Prior,
) -> Banded {
    let mut band = Banded::zeros(6 * unknowns.splines[which].count, HALF_BANDWIDTH);
    prior.add_to_band(which, &mut band);
    for (row, data) in rows.iter().zip(data).filter(|(_, data)| data.members > 0) {
        let (first, weights) = &row.knots[which];
        for a in 0..4 {
            for b in 0..=a {
                let weight = weights[a] * weights[b];
                for i in 0..6 {
                    let columns = if a == b { i + 1 } else { 6 };
                    for j in 0..columns {
                        band.add(6 * (first + a) + i, 6 * (first + b) + j, weight * data.hessian[(i, j)]);
                    }
                }
            }
        }
    }
    band
}

fn globals(
    unknowns: &Unknowns,
    free: &Free,
    rows: &[&Row],
    data: &[FrameData],
    prior: &Prior,
) -> Option<Cholesky<f64, Dyn>> {
    if !(0..GLOBALS).any(|i| free.global(i)) {
        return None;
    }
    // Sums over fixed runs of frames, in order: the same bytes on any number of threads.
    const RUN: usize = 256;
    let frames: Vec<_> = rows.iter().zip(data).collect();
    let parts: Vec<DMatrix<f64>> = frames
        .par_chunks(RUN)
        .map(|frames| {
            let mut sum = DMatrix::zeros(GLOBALS, GLOBALS);
            for (row, data) in frames.iter().filter(|(_, data)| data.members > 0) {
                let columns = unknowns.global_columns(row, free);
                let columns = DMatrix::from_fn(6, GLOBALS, |i, j| columns[i][j]);
                let weighted = DMatrix::from_column_slice(6, 6, data.hessian.as_slice()) * &columns;
                sum.gemm_tr(1.0, &columns, &weighted, 1.0);
            }
            sum
        })
        .collect();
    let mut matrix = parts.iter().fold(DMatrix::zeros(GLOBALS, GLOBALS), |sum, part| sum + part);
    for i in 0..GLOBALS {
        let precision = if free.global(i) { prior.globals()[i] } else { 1.0 };
        matrix[(i, i)] = (matrix[(i, i)] + precision) * (1.0 + DAMPING);
    }
    Cholesky::new(matrix)
}
