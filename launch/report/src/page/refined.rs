//! What refinement found, and how well each picture is known.

use super::frames;
use super::tables::facts;
use super::text::{count, escape, number, percent};
use crate::{Observed, Refined, TrackerNoise};

/// Its numbers, the pictures over time, and what the operator should know.
pub fn refined(refined: &Refined) -> String {
    let without = refined.without.as_ref().map(|without| {
        let d = &without.comparison.model_to_truth;
        format!("{} mm, 95 % within {} mm", number(d.rms_mm), number(d.p95_mm))
    });
    let give_or_take = |value: f64, sigma: f64, unit: &str| {
        let sigma = if sigma > 0.0 { format!(" \u{b1} {}", number(sigma)) } else { String::new() };
        format!("{}{sigma} {unit}", number(value))
    };
    let [offset, sigma] = refined.offset_error_ms;
    let lag = match refined.rotation_lag_ms {
        [_, 0.0] => "not asked".to_owned(),
        [lag, sigma] => give_or_take(lag, sigma, "ms"),
    };
    // What was held fast is no correction of 0: nobody looked.
    let freed =
        |value, sigma, unit| if refined.hand_eye_freed { give_or_take(value, sigma, unit) } else { "held".into() };
    let shift = freed(refined.hand_eye_shift_mm, refined.hand_eye_shift_sigma_mm, "mm");
    let turn = freed(refined.hand_eye_turn_deg, refined.hand_eye_turn_sigma_deg, "degrees");
    let left_out = match [refined.frames_dropped.saturating_sub(refined.frames_unheld), refined.frames_unheld] {
        [0, 0] => "0".to_owned(),
        [misfits, unheld] => format!("{} that fit nowhere, {} that nothing held", count(misfits), count(unheld)),
    };
    let mut text = facts(
        "What refinement has done; \u{b1} is one standard deviation",
        &[
            ("root mean square without it", without.unwrap_or_default()),
            ("points off their common surface, before", format!("{} mm", number(refined.residual_before_mm))),
            ("and after", format!("{} mm", number(refined.residual_after_mm))),
            ("the rig's pose offset is too large by", give_or_take(offset, sigma, "ms")),
            ("orientations are older than the tracker says by", lag),
            ("hand-eye shift corrected by", shift),
            ("hand-eye rotation corrected by", turn),
            ("error of a frame along its rays, as stated", format!("{} mm", number(refined.frame_sigma_mm))),
            ("frames left out", left_out),
        ],
    );
    text.push_str(&tracker(&refined.tracker));
    text.push_str(&refined.observed.as_ref().map(observed).unwrap_or_default());
    text.push_str(&frames::plots(&refined.frames));
    if !refined.notices.is_empty() {
        let notices: String = refined.notices.iter().map(|notice| format!("<li>{}</li>", escape(notice))).collect();
        text.push_str(&format!("<div class=\"verdict\"><ul>{notices}</ul></div>"));
    }
    text
}

fn tracker(noise: &TrackerNoise) -> String {
    let believed = match noise.inflation {
        0.0..=1.0 => "as their noise allows".to_owned(),
        inflation => format!("{} times less than their noise allows", number(inflation)),
    };
    let excess =
        noise.excess.map_or("too little was seen to tell".to_owned(), |excess| format!("{} times", number(excess)));
    facts(
        "What the tracker's readings are like",
        &[
            ("white noise along one axis", format!("{} mm", number(noise.position_mm))),
            ("and about one axis", format!("{} degrees", number(noise.rotation_deg))),
            ("their errors beside what white noise allows; above 0.55 they last", excess),
            ("readings were believed", believed),
        ],
    )
}

fn observed(observed: &Observed) -> String {
    let [x, y, z] = observed.stripes_along.map(|c| format!("{c:.2}"));
    facts(
        "What the scan determines",
        &[
            ("of the surface, crossed by stripes of two directions", percent(observed.crossing.clamp(0.0, 1.0))),
            ("most stripes run along (world)", format!("{x}, {y}, {z}")),
            ("motions of the whole that its shape holds", format!("{} of 6", observed.held_directions)),
        ],
    )
}
