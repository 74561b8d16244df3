//! One round: what the pictures say as they stand, what they agree on, and each of them against the others.

use crate::Painter;
use crate::settle::Shot;
use crate::settle::consensus::{Witnesses, white};
use crate::settle::fit::Comparison;
use crate::settle::level::Level;
use crate::settle::view::View;
use nalgebra::Point3;
use rayon::prelude::*;

/// Focal length in pixels that the rounds are made for: finer pictures are made smaller still.
const ROUNDS_FX: f64 = 1200.0;

/// What stays the same from round to round.
pub struct Round<'a> {
    pub painter: &'a Painter,
    pub shots: &'a [Shot<'a>],
    pub points: &'a [Point3<f64>],
}

impl Round<'_> {
    /// What each view says in each of its places, by pictures made smaller by `factor`.
    pub fn said(&self, views: &[View], factor: usize) -> Vec<Vec<[f32; 3]>> {
        let camera = &self.painter.region.camera;
        let says = |(view, (picture, _)): (&View, &Shot<'_>)| match view.seen.len() {
            0 => Vec::new(),
            _ => view.says(camera, &self.level(picture, factor), self.points, &view.correction),
        };
        views.par_iter().zip(self.shots).map(says).collect()
    }

    /// Compares each view with what the others agree on; the second argument is the value of white.
    pub fn compared<R: Send>(
        &self,
        views: &[View],
        witnesses: &Witnesses,
        factor: usize,
        with: impl Fn(&Comparison<'_>, f64) -> R + Sync,
    ) -> Vec<R> {
        let said = self.said(views, factor);
        let agreed = witnesses.agree(views, &said);
        let white = white(&agreed);
        let compare = |((view, said), (picture, _)): ((&View, &Vec<[f32; 3]>), &Shot<'_>)| {
            let level = match view.seen.len() {
                0 => Level::default(),
                _ => self.level(picture, factor),
            };
            let camera = &self.painter.region.camera;
            with(&Comparison::new(camera, &level, self.points, view, (&agreed, said)), white)
        };
        views.par_iter().zip(&said).zip(self.shots).map(compare).collect()
    }

    fn level(&self, picture: &crate::Picture, factor: usize) -> Level {
        let finer = (self.painter.region.camera.fx / ROUNDS_FX).round().max(1.0) as usize;
        Level::new(picture, factor * finer, self.painter.config.saturated_from)
    }
}
