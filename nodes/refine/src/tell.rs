//! What a revision rests on, in the words and numbers of the bus.

use crate::{Evidence, Notice};
use wire::{Bulk, FrameFit, Header, Refinement};

/// As a message.
pub(crate) fn message(evidence: &Evidence, header: Header) -> Refinement {
    let metres = |mm: f64| mm * 1e-3;
    let nanos = |ms: f64| (ms * 1e6).round() as i64;
    let fits = evidence.frames.iter().map(|frame| FrameFit {
        stamp_nanos: frame.stamp_nanos,
        residual_m: frame.residual_mm.map_or(f32::NAN, |mm| metres(mm) as f32),
        sigma_m: metres(frame.sigma_mm) as f32,
    });
    let hand_eye = &evidence.hand_eye;
    Refinement {
        header,
        residual_before_m: metres(evidence.residual.before_mm),
        residual_after_m: metres(evidence.residual.after_mm),
        pose_offset_error_nanos: nanos(evidence.clock.tau_ms),
        pose_offset_sigma_nanos: evidence.clock.sigma_ms.map_or(0, nanos),
        hand_eye_shift_m: hand_eye.shift_mm.map(metres),
        hand_eye_turn_rad: hand_eye.turn_deg.map(f64::to_radians),
        hand_eye_shift_sigma_m: hand_eye.shift_sigma_mm.map(metres),
        hand_eye_turn_sigma_rad: hand_eye.turn_sigma_deg.map(f64::to_radians),
        frames_dropped: evidence.dropped.len() as u64,
        notices: evidence.notices.iter().map(sentence).collect(),
        frames: fits.collect::<Bulk<_>>(),
    }
}

/// For a person.
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
        Notice::StepTakenBack => "a step made the fit worse and was taken back; the best revision was kept".to_owned(),
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
