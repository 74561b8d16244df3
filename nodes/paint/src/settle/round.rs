//! One round: what the pictures say as they stand, what they agree on, and each of them against the others.

use crate::Painter;
use crate::settle::Shot;
use crate::settle::consensus::{Witnesses, white};
use crate::settle::fit::{Comparison, Prior, precision};
use crate::settle::level::Level;
use crate::settle::see::Points;
use crate::settle::together::Together;
use crate::settle::view::View;
use nalgebra::Vector6;
use rayon::prelude::*;

/// Focal length in pixels that the rounds are made for: finer pictures are made smaller still.
const ROUNDS_FX: f64 = 1200.0;

/// What stays the same while the pictures have one size.
pub struct Round<'a> {
    pub painter: &'a Painter,
    pub points: &'a Points,
    /// One for each view; empty for one that sees nothing.
    levels: Vec<Level>,
}

impl<'a> Round<'a> {
    /// The pictures made smaller by `factor`.
    pub fn new(painter: &'a Painter, shots: &[Shot<'_>], points: &'a Points, views: &[View], factor: usize) -> Self {
        let finer = (painter.region.camera.fx / ROUNDS_FX).round().max(1.0) as usize;
        let level = |(view, (picture, _)): (&View, &Shot<'_>)| match view.seen.len() {
            0 => Level::default(),
            _ => Level::new(picture, factor * finer, painter.config.saturated_from),
        };
        Self { painter, points, levels: views.par_iter().zip(shots).map(level).collect() }
    }

    /// What each view says in each of its places.
    pub fn said(&self, views: &[View]) -> Vec<Vec<[f32; 3]>> {
        let camera = &self.painter.region.camera;
        let says = |(view, level): (&View, &Level)| view.says(camera, level, &self.points.places, &view.correction);
        views.par_iter().zip(&self.levels).map(says).collect()
    }

    /// Compares each view with what the others agree on; the second argument is the value of white.
    pub fn compared<R: Send>(
        &self,
        views: &[View],
        witnesses: &Witnesses,
        with: impl Fn(&Comparison<'_>, f64) -> R + Sync,
    ) -> Vec<R> {
        let said = self.said(views);
        let agreed = witnesses.agree(views, &said);
        let white = white(&agreed);
        let compare = |((view, said), level): ((&View, &Vec<[f32; 3]>), &Level)| {
            let camera = &self.painter.region.camera;
            with(&Comparison::new(camera, level, &self.points.places, view, (&agreed, said)), white)
        };
        views.par_iter().zip(&said).zip(&self.levels).map(compare).collect()
    }

    /// The corrections after one step of all views at once; no step is longer than a standard deviation of the prior.
    pub fn together(&self, views: &[View], witnesses: &Witnesses, prior: &Prior) -> Vec<Vector6<f64>> {
        let linear = |comparison: &Comparison<'_>, white| comparison.linear(white);
        let (slots, gains) = self.compared(views, witnesses, linear).into_iter().unzip();
        let mut together = Together { views, witnesses, slots, gains, precision: precision(prior) };
        together.share_slopes(&self.points.normals);
        let bounded = |(view, step): (&View, Vector6<f64>)| {
            let [shift, turn] = [0, 3].map(|first| step.fixed_rows::<3>(first).norm());
            view.correction + step / (shift / prior.shift_m).max(turn / prior.turn_rad).max(1.0)
        };
        views.iter().zip(together.step()).map(bounded).collect()
    }
}
