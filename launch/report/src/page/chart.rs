//! Inline drawings: the histogram of the distances, and the scale of the error map.

use super::text::number;
use crate::error_map::SCALE;
use std::fmt::Write as _;

const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 220.0;
const BASE: f64 = 184.0;
const BARS: usize = 60;

/// The share of the surface at each signed distance, between -`end_mm` and `end_mm`; with the colours of the error map,
/// so that the one can be read with the other.
pub fn histogram(signed_mm: &[f32], end_mm: f64) -> String {
    let mut counts = [0usize; BARS];
    let mut beyond = 0;
    for &distance in signed_mm {
        let at = 0.5 * (f64::from(distance) / end_mm + 1.0) * BARS as f64;
        if (0.0..BARS as f64).contains(&at) { counts[at as usize] += 1 } else { beyond += 1 }
    }
    let highest = counts.iter().copied().max().unwrap_or(0).max(1) as f64;
    let mut svg = format!(
        r#"<svg class="chart" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="Histogram of distances from the truth">"#
    );
    let step = WIDTH / BARS as f64;
    for (i, &n) in counts.iter().enumerate() {
        let height = (BASE - 12.0) * n as f64 / highest;
        let (x, y) = (i as f64 * step + 0.75, BASE - height);
        let middle_mm = ((i as f64 + 0.5) / BARS as f64 * 2.0 - 1.0) * end_mm;
        let share = 100.0 * n as f64 / signed_mm.len().max(1) as f64;
        let _ = write!(
            svg,
            r#"<rect x="{x:.2}" y="{y:.2}" width="{:.2}" height="{height:.2}" fill="{}"><title>{} mm: {share:.2} %</title></rect>"#,
            step - 1.5,
            css_colour(middle_mm / end_mm),
            number(middle_mm),
        );
    }
    axis(&mut svg, end_mm);
    svg.push_str("</svg>");
    let share = 100.0 * beyond as f64 / signed_mm.len().max(1) as f64;
    let outside =
        if beyond == 0 { String::new() } else { format!(" {share:.2} % of the surface lie beyond the ends.") };
    format!(
        "<figure>{svg}<figcaption>Share of the model's surface at each distance from the truth, in mm; negative is inside \
         the truth.{outside}</figcaption></figure>"
    )
}

fn axis(svg: &mut String, end_mm: f64) {
    let _ = write!(svg, r#"<path class="axis" d="M0 {BASE}H{WIDTH}"/>"#);
    for (i, label) in tick_labels(end_mm).iter().enumerate() {
        let x = (i as f64 / 4.0 * WIDTH).clamp(0.5, WIDTH - 0.5);
        let anchor = ["start", "middle", "middle", "middle", "end"][i];
        let _ = write!(
            svg,
            r#"<path class="axis" d="M{x} {BASE}v6"/><text x="{x}" y="{}" text-anchor="{anchor}">{label}</text>"#,
            BASE + 23.0,
        );
    }
}

/// Both ends, half of them, and nothing: with as many decimals as half an end needs.
fn tick_labels(end_mm: f64) -> [String; 5] {
    let half = 0.5 * end_mm;
    let is_whole = |decimals: &usize| {
        let scaled = half * 10f64.powi(*decimals as i32);
        (scaled - scaled.round()).abs() < 1e-6
    };
    let decimals = (0..4).find(is_whole).unwrap_or(3);
    let label = |sign: &str, value: f64| format!("{sign}{value:.decimals$}");
    [label("\u{2212}", end_mm), label("\u{2212}", half), "0".to_owned(), label("+", half), label("+", end_mm)]
}

/// The scale of the error map.
pub fn legend(end_mm: f64) -> String {
    let mut svg =
        String::from(r#"<svg class="legend" viewBox="0 0 400 40" role="img" aria-label="Scale of distances">"#);
    svg.push_str(r#"<defs><linearGradient id="scale">"#);
    for (i, [r, g, b]) in SCALE.iter().enumerate() {
        let offset = 100.0 * i as f64 / (SCALE.len() - 1) as f64;
        let _ = write!(svg, r#"<stop offset="{offset:.2}%" stop-color="rgb({r},{g},{b})"/>"#);
    }
    svg.push_str(r#"</linearGradient></defs><rect x="20" y="2" width="320" height="12" fill="url(#scale)"/>"#);
    for (i, label) in tick_labels(end_mm).iter().enumerate() {
        let x = 20.0 + 80.0 * i as f64;
        let _ = write!(
            svg,
            r#"<path class="axis" d="M{x} 14v5"/><text x="{x}" y="34" text-anchor="middle">{label}</text>"#
        );
    }
    svg.push_str(r#"<text x="350" y="12">mm</text></svg>"#);
    svg
}

/// The colour at -1..1 of the scale, as a picture stores it.
fn css_colour(at: f64) -> String {
    let [r, g, b] = crate::error_map::colour(at, 1.0).map(|c| crate::albedo::encoded_255(c).round());
    format!("rgb({r},{g},{b})")
}
