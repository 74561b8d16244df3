//! Whether a correction is believed, and what came of them all.

use crate::painter::refusals;
use crate::settle::fit::{Comparison, POINTS_MIN, Prior};
use crate::settle::view::View;
use crate::settle::{SettleRefusal, Settling};
use geometry::METRES_PER_MM;
use nalgebra::Vector6;

/// A correction must bring the robust mean of the squared differences down to this share: where poses are right, what is
/// left of differences comes from the surface, and following it would gain a tenth.
const BETTER: f64 = 0.8;
/// Corrections beyond so many standard deviations of the prior are none.
const FAR_SIGMAS: f64 = 4.0;

/// What became of one picture.
pub struct Verdict {
    /// Why it stays where it was.
    pub refusal: Option<SettleRefusal>,
    /// How far it is from the others in the end, as a share of white; `None` when too little is seen.
    pub apart: Option<f64>,
}

/// How far a view is from what the others say, as it stands: the median, as a share of white; `None` when too little is
/// seen.
pub fn apart(comparison: &Comparison<'_>, white: f64) -> Option<f64> {
    let (agreement, _) = comparison.agreement(&comparison.view.correction, white, None);
    (agreement.points >= POINTS_MIN).then_some(agreement.median / white)
}

/// Judges a view's correction by what the others say in the end.
pub fn of(comparison: &Comparison<'_>, white: f64, prior: &Prior) -> Verdict {
    let (after, scale) = comparison.agreement(&comparison.view.correction, white, None);
    let (before, _) = comparison.agreement(&Vector6::zeros(), white, Some(scale));
    let [shift_m, turn_rad] = comparison.view.size();
    let refusal = if before.points.min(after.points) < POINTS_MIN {
        Some(SettleRefusal::Blind)
    } else if shift_m > FAR_SIGMAS * prior.shift_m || turn_rad > FAR_SIGMAS * prior.turn_rad {
        Some(SettleRefusal::Far)
    } else {
        (after.cost > BETTER * before.cost).then_some(SettleRefusal::NoBetter)
    };
    let stays = if refusal.is_some() { before } else { after };
    Verdict { refusal, apart: (stays.points >= POINTS_MIN).then_some(stays.median / white) }
}

/// What came of all.
pub fn summary(views: &[View], before: &[Option<f64>], verdicts: &[Verdict]) -> Settling {
    let mut counts = [0; SettleRefusal::ALL.len()];
    verdicts.iter().filter_map(|verdict| verdict.refusal).for_each(|refusal| counts[refusal as usize] += 1);
    let moved = || views.iter().zip(verdicts).filter(|(_, verdict)| verdict.refusal.is_none());
    let [shift, turn] = [0, 1].map(|k| root_mean_square(moved().map(|(view, _)| view.size()[k])));
    Settling {
        pictures: views.len() as u64,
        corrected: moved().count() as u64,
        refused: refusals(&SettleRefusal::ALL, &counts),
        apart_before_255: 255.0 * mean(before.iter().flatten().copied()),
        apart_after_255: 255.0 * mean(verdicts.iter().filter_map(|verdict| verdict.apart)),
        shift_rms_mm: shift / METRES_PER_MM,
        turn_rms_degrees: turn.to_degrees(),
    }
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    mean(values.map(|value| value * value)).sqrt()
}

/// 0 of nothing.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    if count == 0 { 0.0 } else { sum / f64::from(count) }
}
