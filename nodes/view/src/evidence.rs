//! What a refinement says of itself, as the operator reads it: a page of facts, and plots over the time of the scan.

use wire::{FrameFit, Refinement};

/// Plots of single pictures: each has a name, and a value in millimetres at the moment of each picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Of what.
    pub name: &'static str,
    /// Of the pictures.
    pub stamps_nanos: Vec<i64>,
    /// Finite.
    pub values_mm: Vec<f64>,
}

/// Names of the plots, in this order.
pub const SERIES: [&str; 4] = ["sigma", "off the surface", "left out, fits nowhere", "left out, held by nothing"];

/// Which pictures were plotted already.
#[derive(Debug, Default)]
pub struct Plotted {
    scan: u64,
    until_nanos: Option<i64>,
}

impl Plotted {
    /// The pictures that no revision told of before: while the hand moves each is plotted once, as it was found first. Of the
    /// final revision all of them.
    pub fn newer(&mut self, evidence: &Refinement) -> [Series; 4] {
        if evidence.header.scan != self.scan {
            *self = Self { scan: evidence.header.scan, until_nanos: None };
        }
        let from = self.until_nanos.filter(|_| !is_final(evidence));
        let newest = evidence.frames.iter().chain(evidence.left_out()).map(|fit| fit.stamp_nanos).max();
        self.until_nanos = self.until_nanos.max(newest);
        let fits = [&evidence.frames, &evidence.frames, &evidence.misfits, &evidence.unheld];
        let values: [fn(&FrameFit) -> f32; 4] =
            [|fit| fit.sigma_m, |fit| fit.residual_m, |fit| fit.residual_m, |fit| fit.sigma_m];
        std::array::from_fn(|i| {
            let newer = fits[i].iter().filter(|fit| Some(fit.stamp_nanos) > from);
            let told = newer.map(|fit| (fit.stamp_nanos, values[i](fit))).filter(|(_, value)| value.is_finite());
            let (stamps_nanos, values_mm) = told.map(|(stamp, value)| (stamp, mm(f64::from(value)))).unzip();
            Series { name: SERIES[i], stamps_nanos, values_mm }
        })
    }
}

/// Only the final revision knows how well it knows the clock.
pub fn is_final(evidence: &Refinement) -> bool {
    evidence.pose_offset_sigma_nanos > 0
}

/// The facts of a revision, as Markdown.
pub fn summary(evidence: &Refinement) -> String {
    let kind = if is_final(evidence) { "final" } else { "while the scan goes on" };
    let mut text = format!("## Refinement, {kind}\n\n");
    for notice in &evidence.notices {
        text.push_str(&format!("**{notice}**\n\n"));
    }
    text.push_str("| | |\n|---|---|\n");
    for (what, value) in facts(evidence) {
        text.push_str(&format!("| {what} | {value} |\n"));
    }
    text
}

fn facts(evidence: &Refinement) -> Vec<(&'static str, String)> {
    let offset = [evidence.pose_offset_error_nanos, evidence.pose_offset_sigma_nanos].map(ms);
    let lag = [evidence.rotation_lag_error_nanos, evidence.rotation_lag_sigma_nanos].map(ms);
    let lag = if lag[1] > 0.0 { give_or_take(lag, "ms") } else { "not asked".to_owned() };
    let shift = [evidence.hand_eye_shift_m, evidence.hand_eye_shift_sigma_m].map(|v| mm(length(v)));
    let turn = [evidence.hand_eye_turn_rad, evidence.hand_eye_turn_sigma_rad].map(|v| length(v).to_degrees());
    let freed = |value, unit| if evidence.hand_eye_freed { give_or_take(value, unit) } else { "held".to_owned() };
    let tracker = &evidence.tracker;
    let mut facts = vec![
        ("points off their common surface, before", format!("{:.3} mm", mm(evidence.residual_before_m))),
        ("and now", format!("{:.3} mm", mm(evidence.residual_after_m))),
        ("a picture's sigma, median", format!("{:.3} mm", mm(median_sigma_m(&evidence.frames)))),
        ("pictures kept", evidence.frames.len().to_string()),
        ("left out: fit nowhere", evidence.misfits.len().to_string()),
        ("left out: held by nothing", evidence.unheld.len().to_string()),
        ("the rig's pose offset is too large by", give_or_take(offset, "ms")),
        ("orientations are older than said by", lag),
        ("hand-eye shift", freed(shift, "mm")),
        ("hand-eye rotation", freed(turn, "degrees")),
        ("tracker, white noise of one axis", {
            let degrees = tracker.white_rotation_rad.to_degrees();
            format!("{:.2} mm, {degrees:.2} degrees", mm(tracker.white_position_m))
        }),
        ("its readings believed less by", format!("{:.0} times", tracker.inflation)),
    ];
    if let Some(observed) = &evidence.observed {
        let [x, y, z] = observed.stripes_along;
        facts.push(("surface crossed by stripes", format!("{:.0} %", 100.0 * observed.crossing)));
        facts.push(("most stripes along (world)", format!("{x:.2}, {y:.2}, {z:.2}")));
        facts.push(("motions that the surface holds", format!("{} of 6", observed.held_directions)));
    }
    facts
}

/// What a sigma of 0 stands for, nobody has asked yet.
fn give_or_take([value, sigma]: [f64; 2], unit: &str) -> String {
    if sigma > 0.0 { format!("{value:.2} \u{b1} {sigma:.2} {unit}") } else { format!("{value:.2} {unit}") }
}

fn median_sigma_m(frames: &[FrameFit]) -> f64 {
    let mut sigmas: Vec<f32> = frames.iter().map(|fit| fit.sigma_m).collect();
    sigmas.sort_by(f32::total_cmp);
    sigmas.get(sigmas.len() / 2).copied().map_or(f64::NAN, f64::from)
}

fn length(v: [f64; 3]) -> f64 {
    nalgebra::Vector3::from(v).norm()
}

fn mm(metres: f64) -> f64 {
    metres / geometry::METRES_PER_MM
}

fn ms(nanos: i64) -> f64 {
    nanos as f64 * 1e-6
}
