//! What was noticed, for a person.

use crate::Notice;

/// One sentence, with what to do.
pub fn sentence(notice: &Notice) -> String {
    match notice {
        Notice::StrokesDoNotCross { crossing, advice } => format!(
            "strokes cross on {:.0} % of the surface only, so the hand-eye transform was held and sliding along the stripes \
             is not: {advice}",
            100.0 * crossing
        ),
        Notice::ColouredNoise { excess } => format!(
            "the tracker's errors last longer than white noise does ({excess:.1} times what it allows): its readings were \
             believed less"
        ),
        Notice::SurfaceHoldsLittle { held_directions, advice } => {
            format!("the surface holds {held_directions} of the 6 motions of a stroke: {advice}")
        }
        Notice::ThingMoved { stamp_nanos, apart_mm } => format!(
            "the thing was moved at {:.1} s: what was seen before and behind stands {apart_mm:.1} mm apart. Scan it again, \
             or model the longer part alone",
            *stamp_nanos as f64 * 1e-9
        ),
        Notice::StepTakenBack => {
            "a step made the fit worse: it was taken back, and what came before it stands".to_owned()
        }
        Notice::KeptSmoothed => "refinement made nothing better: the smoothed tracker is what is given out".to_owned(),
        Notice::NothingSeenTwice => {
            "too little was seen twice to refine anything: sweep over the same surface again, from other sides"
                .to_owned()
        }
        Notice::HandEyeRanAway { shift_mm, turn_deg } => format!(
            "the hand-eye correction ran away ({shift_mm:.1?} mm, {turn_deg:.1?} degrees) and was held: is the rig's \
             body_from_camera right?"
        ),
    }
}
