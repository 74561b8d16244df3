//! Where the pictures truly were taken from: each is moved a little until all agree on the colour of the surface.
//!
//! A hand trembles at 8 to 12 Hz, by some 0.3 mm and 0.2 degrees, and a picture in the lamp's light stands between others
//! in the laser's, which alone tell the way. So its pose errs by several pixels, and colours blur. The cure is that of Zhou
//! & Koltun 2014, "Color map optimization": in turn, what the pictures agree on for each point of the surface
//! ([`consensus`]), and for each picture the small correction after which it says what the others say ([`fit`]); coarse
//! pictures first ([`level`]). What many pictures err in common hardly moves that way, so at last all are corrected at once
//! ([`together`]). Only points near borders between colours take part ([`detail`]), and each correction is
//! held by its prior: where nothing is to be seen, nothing moves.

mod consensus;
mod detail;
mod fit;
mod level;
mod round;
mod see;
mod together;
mod verdict;
mod view;

use crate::Picture;
use crate::painter::Painter;
use consensus::Witnesses;
use fit::Prior;
use nalgebra::{Isometry3, Vector6};
use round::Round;
use view::{View, keep};
use wire::Refusal;

/// What came of settling the pictures.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Settling {
    /// Pictures that were looked at.
    pub pictures: u64,
    /// Pictures that were moved.
    pub corrected: u64,
    /// Pictures that stayed where they were, by reason.
    pub refused: Vec<Refusal>,
    /// Near borders between colours, how far a picture is from what the others say: the median over its points (the three
    /// channels together), the mean over the pictures, in 255ths of white. As they came.
    pub apart_before_255: f64,
    /// The same at the end.
    pub apart_after_255: f64,
    /// Root mean square shift of the moved pictures.
    pub shift_rms_mm: f64,
    /// Root mean square turn of the moved pictures.
    pub turn_rms_degrees: f64,
}

/// Why a picture stays where it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, thiserror::Error)]
pub enum SettleRefusal {
    /// No surface there, no border between colours on it, or no other picture of it.
    #[error("picture without enough borders between colours to settle by")]
    Blind,
    /// The correction does not help, as where the pose was right.
    #[error("picture that agrees as well where it was")]
    NoBetter,
    /// The correction is beyond what its prior allows.
    #[error("picture that would have to move too far to agree")]
    Far,
}

impl SettleRefusal {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Blind, Self::NoBetter, Self::Far];
}

/// A picture, and world_from_camera as its trajectory has it.
pub type Shot<'a> = (&'a Picture, Isometry3<f64>);

/// One round each, view by view, by pictures made smaller by this factor: poses err by up to ten pixels.
const ROUNDS: [usize; 4] = [8, 4, 4, 2];
/// Then so many steps of all views at once, by the finest pictures.
const STEPS_TOGETHER: usize = 3;
/// By which corrections are judged.
const FINEST: usize = 2;

impl Painter {
    /// Where the pictures were taken from, so that they agree: world_from_camera of each, in their order, and what came
    /// of it. Pictures that cannot be settled keep their pose; without a surface, all do. Nothing is painted.
    pub fn settle(&mut self, shots: &[Shot<'_>]) -> (Vec<Isometry3<f64>>, Settling) {
        let prior = Prior {
            shift_m: self.config.settle_shift_mm * geometry::METRES_PER_MM,
            turn_rad: self.config.settle_turn_degrees.to_radians(),
        };
        let (points, mut views) = self.views(shots, &prior);
        let round = |views: &[View], factor| Round::new(self, shots, &points, views, factor);
        let mut witnesses = Witnesses::of(&views, points.places.len());
        let agreed = witnesses.agree(&views, &round(&views, ROUNDS[0]).said(&views));
        let detailed = detail::with_detail(&points.places, &agreed, consensus::white(&agreed));
        views.iter_mut().for_each(|view| keep(&mut view.seen, &detailed));
        witnesses = Witnesses::of(&views, points.places.len());

        for factor in ROUNDS {
            let settled = |comparison: &fit::Comparison<'_>, white| comparison.settle(&prior, white);
            let corrections = round(&views, factor).compared(&views, &witnesses, settled);
            correct(&mut views, corrections);
        }
        let finest = round(&views, FINEST);
        for _ in 0..STEPS_TOGETHER {
            let corrections = finest.together(&views, &witnesses, &prior);
            correct(&mut views, corrections);
        }
        let judged = |comparison: &fit::Comparison<'_>, white| verdict::of(comparison, white, &prior);
        let verdicts = finest.compared(&views, &witnesses, judged);
        let as_they_came: Vec<View> = views.iter().map(View::as_it_came).collect();
        let before = finest.compared(&as_they_came, &witnesses, verdict::apart);
        let settled =
            shots.iter().zip(&views).zip(&verdicts).map(|(((_, pose), view), verdict)| match verdict.refusal {
                Some(_) => *pose,
                None => view.world_from_camera(),
            });
        (settled.collect(), verdict::summary(&views, &before, &verdicts))
    }
}

fn correct(views: &mut [View], corrections: Vec<Vector6<f64>>) {
    views.iter_mut().zip(corrections).for_each(|(view, correction)| view.correction = correction);
}
