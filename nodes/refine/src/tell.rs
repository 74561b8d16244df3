//! What a revision rests on, in the words and numbers of the bus.

use crate::{DropReason, Evidence, sentence};
use wire::{Bulk, FrameFit, Header, Observed, Refinement, TrackerFit};

/// As a message.
pub(crate) fn message(evidence: &Evidence, header: Header) -> Refinement {
    let metres = |mm: f64| mm * 1e-3;
    let nanos = |ms: f64| (ms * 1e6).round() as i64;
    let fit = |stamp_nanos: i64, residual_mm: Option<f64>, sigma_mm: f64| FrameFit {
        stamp_nanos,
        residual_m: residual_mm.map_or(f32::NAN, |mm| metres(mm) as f32),
        sigma_m: metres(sigma_mm) as f32,
    };
    let kept = evidence.frames.iter().map(|frame| fit(frame.stamp_nanos, frame.residual_mm, frame.sigma_mm));
    let left_out = |reason: DropReason| {
        let dropped = evidence.dropped.iter().filter(move |frame| frame.reason == reason);
        dropped.map(|frame| fit(frame.stamp_nanos, frame.residual_mm, frame.sigma_mm)).collect::<Bulk<_>>()
    };
    let (clock, hand_eye, tracker) = (&evidence.clock, &evidence.hand_eye, &evidence.tracker);
    let lag = clock.rotation_lag_sigma_ms.map(|sigma| [clock.rotation_lag_ms, sigma].map(nanos)).unwrap_or_default();
    Refinement {
        header,
        residual_before_m: metres(evidence.residual.before_mm),
        residual_after_m: metres(evidence.residual.after_mm),
        pose_offset_error_nanos: nanos(clock.tau_ms),
        pose_offset_sigma_nanos: clock.sigma_ms.map_or(0, nanos),
        rotation_lag_error_nanos: lag[0],
        rotation_lag_sigma_nanos: lag[1],
        tracker: TrackerFit {
            white_position_m: metres(tracker.white_position_mm),
            white_rotation_rad: tracker.white_rotation_deg.to_radians(),
            excess: tracker.excess,
            inflation: tracker.inflation,
        },
        hand_eye_freed: hand_eye.freed,
        hand_eye_shift_m: hand_eye.shift_mm.map(metres),
        hand_eye_turn_rad: hand_eye.turn_deg.map(f64::to_radians),
        hand_eye_shift_sigma_m: hand_eye.shift_sigma_mm.map(metres),
        hand_eye_turn_sigma_rad: hand_eye.turn_sigma_deg.map(f64::to_radians),
        observed: evidence.observed.map(|observed| Observed {
            crossing: observed.crossing,
            stripes_along: observed.stripes_along,
            held_directions: observed.held_directions as u32,
        }),
        notices: evidence.notices.iter().map(sentence).collect(),
        frames: kept.collect::<Bulk<_>>(),
        misfits: left_out(DropReason::FitsNowhere),
        unheld: left_out(DropReason::Unheld),
    }
}
